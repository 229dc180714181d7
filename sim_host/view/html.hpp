#pragma once
/// Pages that open from disk: style and scripts are in them, and a policy by which the browser itself refuses
/// to fetch anything.

#include <filesystem>
#include <string>
#include <vector>

#include "sim_host/world/map/escaped.hpp"
#include "sim_host/world/scenario/format.hpp"

namespace s4tp::view {

/// Style and scripts, the bytes of the files of the same name beside this one.
extern const char* const kPageCss;
extern const char* const kReportJs;
extern const char* const kCanvasJs;
extern const char* const kSceneJs;
extern const char* const kReplayHtml;
extern const char* const kReplaySceneJs;
extern const char* const kReplayJs;
extern const char* const kLiveHtml;
extern const char* const kLiveJs;

using map::escaped;
using scenario::format;

/// Deflated (zlib's format), then base64: what a browser's DecompressionStream takes.
[[nodiscard]] std::string packed(const std::string& text);

struct Page {
  std::string title;
  std::string body;                  ///< HTML
  std::string data;                  ///< for the scripts, which find it packed() in #data; may be empty
  std::vector<const char*> scripts;  ///< run in this order, after the body
};

/// The whole page. \param policy  where a browser may fetch from, besides what is in the page
[[nodiscard]] std::string page_text(const Page& page, const std::string& policy);

/// VIEW-002 Opened from disk the page asks the network for nothing and has no error on the console.
/// \throws std::runtime_error when the file cannot be written
void write_page(const Page& page, const std::filesystem::path& file);

}  // namespace s4tp::view
