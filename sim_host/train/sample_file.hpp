#pragma once
/// Files of samples: a header that names the layout, then the rows as they stand in memory, each with its
/// CRC-32. For machines of the writer's kind. A folder of such files is a data set.

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <vector>

#include "sim_host/train/sample.hpp"

namespace s4tp::train {

/// Changes with every change of Sample's meaning.
inline constexpr std::uint32_t kSampleVersion = 2;

/// Writes one file; rows come to rest under the final name when the writer is closed.
class SampleWriter {
 public:
  /// \throws std::runtime_error when the file cannot be written
  explicit SampleWriter(const std::filesystem::path& file);
  void add(const Sample& sample);
  /// \throws std::runtime_error when something was not written
  void close();
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::filesystem::path file_;
  std::filesystem::path unfinished_;
  std::ofstream out_;
  std::size_t size_ = 0;
};

/// The samples of all files named *.samples in a folder, by file name; read from disk as they are needed.
class SampleSet {
 public:
  SampleSet() = default;
  /// TRAIN-001 A file of another layout or version, a truncated or a changed one is refused, and one whose
  /// counts, indices or numbers no drive brings.
  /// \param path  a folder or one file \throws std::runtime_error as above, or when there is nothing
  explicit SampleSet(const std::filesystem::path& path);
  ~SampleSet();
  SampleSet(SampleSet&& other) noexcept;
  SampleSet& operator=(SampleSet&& other) noexcept;
  SampleSet(const SampleSet&) = delete;
  SampleSet& operator=(const SampleSet&) = delete;

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] const Sample& operator[](std::size_t index) const { return *rows_[index]; }

 private:
  struct Mapping {
    void* address;
    std::size_t bytes;
  };
  void map(const std::filesystem::path& file);
  std::vector<Mapping> mappings_;
  std::vector<const Sample*> rows_;
};

/// A set that may be learned from and calibrated on. TRAIN-015 One that holds samples for reporting is refused.
/// \throws std::runtime_error as SampleSet, and so
[[nodiscard]] SampleSet samples_to_learn_from(const std::filesystem::path& path);

/// TRAIN-002 All samples of a road are in one part, whatever else is in the set: of twenty roads one
/// calibrates and one validates.
enum class Part : std::uint8_t { kTraining, kCalibration, kValidation };
[[nodiscard]] Part part_of(std::uint64_t road);

/// Indices of the samples of one part, in order.
[[nodiscard]] std::vector<std::size_t> samples_of(const SampleSet& set, Part part);

}  // namespace s4tp::train
