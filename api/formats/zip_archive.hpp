#pragma once

#include <memory>
#include <stop_token>
#include <string>
#include <string_view>

namespace tubecut::api {

struct ZipMemory;  // what minizip takes for the file

/// A zip archive in memory, file by file, by minizip. Of the same files the same bytes: each has
/// the format's earliest time, 1980-01-01.
class ZipArchive {
 public:
  ZipArchive();
  ~ZipArchive();
  /// `name` in UTF-8, its folders between `/`; each name once. Throws Stopped, and
  /// std::runtime_error where minizip fails.
  void add(const std::string& name, std::string_view bytes, const std::stop_token& stop);
  /// The archive; nothing is added after it.
  [[nodiscard]] std::string take();

 private:
  std::unique_ptr<ZipMemory> memory_;
  std::unique_ptr<void, int (*)(void*)> zip_;
};

}  // namespace tubecut::api
