#include "sim_host/view/html.hpp"

#include <cstdarg>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace s4tp::view {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string format(const char* pattern, ...) {
  char text[400];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

void write_page(const Page& page, const std::filesystem::path& file) {
  std::ofstream out(file);
  out << "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
         "'unsafe-inline'; "
         "script-src 'unsafe-inline'; img-src data: file:\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" "
         "href=\"data:,\">\n<title>"
      << escaped(page.title) << "</title>\n<style>\n"
      << kPageCss << "</style>\n</head>\n<body>\n"
      << page.body;
  if (!page.data.empty()) {
    std::string data = page.data;  // "</" would end the script
    for (std::size_t at = data.find("</"); at != std::string::npos; at = data.find("</", at + 3)) {
      data.replace(at, 2, "<\\/");
    }
    out << "<script type=\"application/json\" id=\"data\">" << data << "</script>\n";
  }
  for (const char* const script : page.scripts) out << "<script>\n" << script << "</script>\n";
  out << "</body>\n</html>\n";
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace s4tp::view
