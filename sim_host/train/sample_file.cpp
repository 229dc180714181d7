#include "sim_host/train/sample_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "sim_host/train/random_number.hpp"

namespace s4tp::train {
namespace {

constexpr float kMostProbable = 1.001F;  // 1, rounded

struct Header {
  char magic[8] = {'S', '4', 'T', 'P', 'S', 'M', 'P', 'L'};
  std::uint32_t version = kSampleVersion;
  std::uint32_t row_bytes = sizeof(Sample);
  std::uint32_t input_bytes = sizeof(satp::NetworkInput);
  std::uint32_t plan_bytes = sizeof(satp::PlanInput);
  std::uint32_t target_bytes = sizeof(satp::TargetPoses);
  std::uint32_t byte_order = 0x01020304;
};

// A sample on disk.
struct Row {
  Sample sample;
  std::uint32_t crc = 0;
  std::uint32_t reserved = 0;
};
static_assert(sizeof(Header) % alignof(Row) == 0, "rows stand aligned behind it");

std::uint32_t crc_of(const Sample& sample) {
  return static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(&sample), sizeof sample));
}

template <class Array>
bool finite(const Array& values) {
  static_assert(std::is_same_v<std::remove_all_extents_t<Array>, float>);
  const auto* const first = reinterpret_cast<const float*>(&values);
  return std::all_of(first, first + sizeof values / sizeof(float),
                     [](float one) { return std::isfinite(one); });
}

bool sound(const KinematicFuture& future) {
  for (int mode = 0; mode < kMaxModes; ++mode) {
    const float share = future.probability[mode];
    if (!(share >= 0.0F && share <= kMostProbable) || future.yields[mode] > 1) return false;
  }
  return true;
}

/// What arrays and bins are indexed by is within them: a checksum keeps nobody from writing anything else.
bool sound(const Sample& sample) {
  const satp::NetworkInput& input = sample.input;
  if (input.hdvs < 0 || input.hdvs > kMaxAgents) return false;
  for (int i = 0; i < kMaxAgents; ++i) {
    if (sample.route[i] < -1 || sample.route[i] >= kPathsPerAgent || sample.yields[i] < -1 ||
        sample.yields[i] > 1 || !sound(sample.kinematic[i])) {
      return false;
    }
    for (const std::uint8_t points : input.lane_points[i]) {
      if (points > satp::kLanePoints) return false;
    }
  }
  return finite(input.speed_mps) && finite(input.ego_history) && finite(input.history) &&
         finite(input.place) && finite(input.lane) && finite(input.pair) && finite(sample.plan.step) &&
         finite(sample.target.pose);
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw std::runtime_error(file.string() + ": " + why);
}

}  // namespace

SampleWriter::SampleWriter(const std::filesystem::path& file)
    : file_(file), unfinished_(file.string() + ".part"), out_(unfinished_, std::ios::binary) {
  const Header header;
  out_.write(reinterpret_cast<const char*>(&header), sizeof header);
  if (!out_) refuse(unfinished_, "cannot be written");
}

void SampleWriter::add(const Sample& sample) {
  Row row{};
  std::memcpy(&row.sample, &sample, sizeof sample);  // padding, too: the checksum is of all bytes written
  row.crc = crc_of(row.sample);
  out_.write(reinterpret_cast<const char*>(&row), sizeof row);
  ++size_;
}

void SampleWriter::close() {
  out_.close();
  if (!out_) refuse(unfinished_, "not all was written");
  std::filesystem::rename(unfinished_, file_);
}

SampleSet::SampleSet(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(path)) {
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
      if (entry.path().extension() == ".samples") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
  } else {
    files.push_back(path);
  }
  for (const auto& file : files) map(file);
  if (rows_.empty()) refuse(path, "no samples");
}

SampleSet::~SampleSet() {
  for (const Mapping& mapping : mappings_) munmap(mapping.address, mapping.bytes);
}

SampleSet::SampleSet(SampleSet&& other) noexcept
    : mappings_(std::exchange(other.mappings_, {})), rows_(std::exchange(other.rows_, {})) {}

SampleSet& SampleSet::operator=(SampleSet&& other) noexcept {
  std::swap(mappings_, other.mappings_);
  std::swap(rows_, other.rows_);
  return *this;
}

void SampleSet::map(const std::filesystem::path& file) {
  std::error_code failure;
  const std::size_t bytes = std::filesystem::file_size(file, failure);
  if (failure) refuse(file, failure.message());
  if (bytes < sizeof(Header) || (bytes - sizeof(Header)) % sizeof(Row) != 0) {
    refuse(file, "not whole, or not of samples");
  }
  const int descriptor = open(file.c_str(), O_RDONLY);
  if (descriptor < 0) refuse(file, "cannot be read");
  void* address = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, descriptor, 0);
  close(descriptor);
  if (address == MAP_FAILED) refuse(file, "cannot be mapped");
  mappings_.push_back({address, bytes});
  const Header expected;
  if (std::memcmp(address, &expected, sizeof expected) != 0) refuse(file, "samples of another layout");
  const auto* rows = reinterpret_cast<const Row*>(static_cast<const char*>(address) + sizeof(Header));
  for (std::size_t i = 0; i < (bytes - sizeof(Header)) / sizeof(Row); ++i) {
    if (crc_of(rows[i].sample) != rows[i].crc)
      refuse(file, "sample " + std::to_string(i) + " has been changed");
    if (!sound(rows[i].sample)) refuse(file, "sample " + std::to_string(i) + " holds what no drive brings");
    rows_.push_back(&rows[i].sample);
  }
}

SampleSet samples_to_learn_from(const std::filesystem::path& path) {
  SampleSet set(path);
  for (std::size_t i = 0; i < set.size(); ++i) {
    if ((set[i].flags & kReporting) != 0)
      refuse(path, "for reporting (train data --reporting): learned from are seeds and roads below " +
                       std::to_string(kBlocksBegin));
  }
  return set;
}

Part part_of(std::uint64_t road) {
  switch (random_number(0x5A3D, road) % 20) {
    case 0:
      return Part::kCalibration;
    case 1:
      return Part::kValidation;
    default:
      return Part::kTraining;
  }
}

std::vector<std::size_t> samples_of(const SampleSet& set, Part part) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (part_of(set[i].road) == part) result.push_back(i);
  }
  return result;
}

}  // namespace s4tp::train
