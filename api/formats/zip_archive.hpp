#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace tubecut::api {

struct ZipMemory;  // the file in minizip's terms

/// A zip archive in memory, file by file, by minizip. Of the same files the same bytes: each has
/// the format's earliest time, 1980-01-01.
class ZipArchive {
 public:
  ZipArchive();
  ~ZipArchive();
  /// `name` in UTF-8, its folders between `/`; each name once. Throws Stopped if cancelled, and
  /// std::runtime_error if minizip fails.
  void add(const std::string& name, std::string_view bytes);
  /// Returns the archive; call nothing after it.
  [[nodiscard]] std::string take();

 private:
  std::unique_ptr<ZipMemory> memory_;
  std::unique_ptr<void, int (*)(void*)> zip_;
};

}  // namespace tubecut::api
