#include "sim_host/recording/series.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace s4tp::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kFlush_us = 1'000'000;  // a sudden end costs no more than that
constexpr const char* kInterface = "vcan0";
constexpr int kLongestLine = 512;

fs::path part(const fs::path& first, int number) {
  fs::path file = first;
  if (number > 0) file += "." + std::to_string(number);
  return file;
}

/// The number of a file in the series; -1: it is not of it.
int number_in(const std::string& first, const std::string& name) {
  if (name == first) return 0;
  if (!name.starts_with(first + ".")) return -1;
  const std::string digits = name.substr(first.size() + 1);
  const bool number = !digits.empty() && digits.size() < 9 && digits[0] != '0' &&
                      digits.find_first_not_of("0123456789") == std::string::npos;
  return number ? std::stoi(digits) : -1;
}

int number_of(const fs::path& first, const fs::path& file) {
  return number_in(first.filename().string(), file.filename().string());
}

fs::path first_of(const fs::path& file) {
  return file.filename().empty() ? file.parent_path() : file;
}

bool all_of(const std::string& text, const char* accepted) {
  return !text.empty() && text.find_first_not_of(accepted) == std::string::npos;
}

/// "(1436509052.249713)"
bool is_time(const std::string& word) {
  constexpr std::size_t kMicroseconds = 6;
  if (word.size() < kMicroseconds + 4 || word.front() != '(' || word.back() != ')') return false;
  const std::size_t point = word.size() - kMicroseconds - 2;
  return word[point] == '.' && all_of(word.substr(1, point - 1), "0123456789") &&
         all_of(word.substr(point + 1, kMicroseconds), "0123456789");
}

/// A line of candump's with a frame that is none of ours: 29 bits of id, CAN FD, remote, error.
bool other_frame(const std::string& line) {
  constexpr const char* kHex = "0123456789ABCDEFabcdef";
  constexpr const char* kBytes = "0123456789ABCDEFabcdef.";
  std::istringstream words(line);
  std::string time, interface, frame, direction, more;
  words >> time >> interface >> frame >> direction >> more;
  if (!is_time(time) || !more.empty() || (!direction.empty() && direction != "R" && direction != "T")) {
    return false;
  }
  const std::size_t mark = frame.find('#');
  if (mark == std::string::npos || !all_of(frame.substr(0, mark), kHex)) return false;
  const std::string data = frame.substr(mark + 1);
  const bool fd = data.size() > 1 && data[0] == '#' && all_of(data.substr(1), kBytes);
  const bool remote =
      data == "R" || (data.size() == 2 && data[0] == 'R' && all_of(data.substr(1), "0123456789"));
  const bool long_id = mark == 8 && (data.empty() || all_of(data, kBytes));
  return long_id || (mark >= 3 && mark <= 8 && (fd || remote));
}

/// The beginning of a line, whatever bytes are in it.
std::string shown(const std::string& line) {
  std::string text = line.substr(0, 40);
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

}  // namespace

std::vector<fs::path> files_of(const fs::path& file) {
  const fs::path first = first_of(file);
  const fs::path folder = first.has_parent_path() ? first.parent_path() : fs::path(".");
  std::vector<std::pair<int, fs::path>> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const int number = number_of(first, entry.path());
    if (number >= 0 && entry.is_regular_file()) found.emplace_back(number, part(first, number));
  }
  std::sort(found.begin(), found.end());
  std::vector<fs::path> files;
  for (auto& [number, path] : found) files.push_back(std::move(path));
  return files;
}

SeriesWriter::SeriesWriter(const fs::path& file, const SeriesLimits& limits) : first_(file), limits_(limits) {
  if (fs::is_directory(file)) throw std::runtime_error(file.string() + ": is a folder; name a file in it");
  if (const auto there = files_of(file); !there.empty()) {
    throw std::runtime_error(there.front().string() +
                             ": is there already and is not written over; name another --record, or remove "
                             "it with all of its series");
  }
  if (file.has_parent_path()) {
    std::error_code error;
    fs::create_directories(file.parent_path(), error);  // opening says what is wrong
  }
  open(file);
}

void SeriesWriter::open(const fs::path& file) {
  stream_ = std::ofstream(file, std::ios::binary);
  current_ = file;
  written_bytes_ = 0;
  check();
}

void SeriesWriter::write(std::uint64_t time_us, const std::vector<wire::Frame>& frames, bool begins_tick) {
  if (begins_tick && written_bytes_ >= limits_.file_bytes) {
    flush();
    open(part(first_, ++number_));
    if (limits_.keep > 0 && number_ >= limits_.keep) fs::remove(part(first_, number_ - limits_.keep));
  }
  for (const wire::Frame& frame : frames) {
    wire::LoggedFrame logged{time_us, {}, frame};
    std::strncpy(logged.interface, kInterface, sizeof logged.interface - 1);
    char line[wire::kCandumpLineSize];
    const int size = wire::format_candump(logged, line);
    stream_.write(line, size).put('\n');
    written_bytes_ += static_cast<std::uint64_t>(size) + 1U;
  }
  check();
  if (begins_tick && time_us >= flushed_us_ + kFlush_us) {
    flushed_us_ = time_us;
    flush();
  }
}

void SeriesWriter::flush() {
  stream_.flush();
  check();
}

void SeriesWriter::check() const {
  if (stream_) return;
  const std::string reason = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
  throw std::runtime_error(current_.string() + ": the recording cannot be written" + reason);
}

SeriesReader::SeriesReader(const fs::path& file) : files_(files_of(file)) {
  if (files_.empty()) {
    throw std::runtime_error(file.string() +
                             ": there is no such recording; ./s4tp run --record FILE makes one");
  }
  begins_later_ = number_of(first_of(file), files_.front()) != 0;
  for (std::size_t i = 1; i < files_.size(); ++i) {
    if (number_of(first_of(file), files_[i]) == number_of(first_of(file), files_[i - 1]) + 1) continue;
    damage_ = files_[i - 1].string() + ": the file after it is missing (there is " + files_[i].string() + ")";
    files_.resize(i);
  }
  stream_.open(files_[0], std::ios::binary);
}

bool SeriesReader::fail(const std::string& what) {
  damage_ = place().text() + ": " + what;
  stream_.close();
  files_.resize(file_ + 1);
  return false;
}

bool SeriesReader::next_file() {
  if (file_ + 1 >= files_.size()) return false;
  stream_ = std::ifstream(files_[++file_], std::ios::binary);
  line_ = 0;
  return true;
}

bool SeriesReader::next(Record& record) {
  for (;;) {
    if (!stream_.is_open()) return line_ == 0 ? fail("cannot be read") : false;
    char line[kLongestLine];
    stream_.getline(line, sizeof line);
    const auto got = static_cast<int>(stream_.gcount());
    if (stream_.eof() && got == 0) {
      if (!next_file()) return false;
      continue;
    }
    ++line_;
    if (stream_.eof()) return fail("the line has no end: cut off");
    if (!stream_) return fail("no line of candump's is that long");
    const int size = got - 1;
    const wire::CandumpResult result = wire::parse_candump(line, size, record.logged);
    record.line = line_;
    record.comment.clear();
    if (result == wire::CandumpResult::kSkipped) {
      const std::string text(line, static_cast<std::size_t>(size));
      if (const std::size_t begin = text.find('#'); begin != std::string::npos) {
        record.comment = text.substr(begin);
        return true;
      }
      continue;
    }
    if (result == wire::CandumpResult::kMalformed) {
      const std::string text(line, static_cast<std::size_t>(size));
      if (!other_frame(text)) return fail("no frame as candump writes it: \"" + shown(text) + '"');
      ++passed_over_;
      continue;
    }
    if (record.logged.time_us < time_us_) return fail("time steps back: not of the same recording");
    time_us_ = record.logged.time_us;
    return true;
  }
}

}  // namespace s4tp::recording
