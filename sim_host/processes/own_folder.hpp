#pragma once
/// Folders for results nobody named one for.

#include <filesystem>
#include <utility>

namespace s4tp::processes {

/// A folder made for a result; it goes again with this object if nothing was written to it.
class OwnFolder {
 public:
  OwnFolder() = default;
  explicit OwnFolder(std::filesystem::path made) : made_(std::move(made)) {}
  ~OwnFolder();
  OwnFolder(OwnFolder&& from) noexcept : made_(std::exchange(from.made_, {})) {}
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;

 private:
  std::filesystem::path made_;
};

/// Where to write a result. A folder that was named stays as it is; else it becomes one of this result's own: itself,
/// or, where a result is already, the next free of FOLDER-2, FOLDER-3, ... FILE-010 It is made here, so that two
/// commands at the same time never get the same one. \throws std::runtime_error
[[nodiscard]] OwnFolder choose_folder(std::filesystem::path& folder, bool named);

}  // namespace s4tp::processes
