#include "sim_host/view/html.hpp"

#include <zlib.h>

#include <fstream>
#include <stdexcept>

namespace s4tp::view {

std::string packed(const std::string& text) {
  uLongf size = compressBound(text.size());
  std::vector<Bytef> bytes(size);
  if (compress2(bytes.data(), &size, reinterpret_cast<const Bytef*>(text.data()), text.size(),
                Z_BEST_COMPRESSION) != Z_OK) {
    throw std::runtime_error("a page's data cannot be compressed");
  }
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  for (uLongf i = 0; i < size; i += 3) {
    const auto byte = [&](uLongf at) { return at < size ? static_cast<unsigned>(bytes[at]) : 0U; };
    const unsigned three = (byte(i) << 16U) | (byte(i + 1) << 8U) | byte(i + 2);
    for (int digit = 0; digit < 4; ++digit) {
      const bool there = i + static_cast<uLongf>(digit) <= size;
      result += there ? kDigits[(three >> (18 - 6 * digit)) & 63U] : '=';
    }
  }
  return result;
}

std::string page_text(const Page& page, const std::string& policy) {
  std::string text =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
      "script-src 'unsafe-inline'; " +
      policy +
      "\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" "
      "href=\"data:,\">\n<title>" +
      escaped(page.title) + "</title>\n<style>\n" + kPageCss + "</style>\n</head>\n<body>\n" + page.body;
  if (!page.data.empty()) {
    text += "<script type=\"text/plain\" id=\"data\">" + packed(page.data) + "</script>\n";
  }
  for (const char* const script : page.scripts) text += std::string("<script>\n") + script + "</script>\n";
  return text + "</body>\n</html>\n";
}

void write_page(const Page& page, const std::filesystem::path& file) {
  std::ofstream out(file);
  out << page_text(page, "img-src data: file:");
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace s4tp::view
