#include "api/formats/zip_archive.hpp"

#include <minizip/zip.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "api/stop.hpp"

namespace tubecut::api {

struct ZipMemory {
  std::string bytes = {};
  std::size_t at = 0;

  static ZipMemory& of(void* opaque) { return *static_cast<ZipMemory*>(opaque); }
  static void* open(void* opaque, const void*, int) { return opaque; }
  static uLong read(void* opaque, void*, void* to, uLong size) {
    auto& m = of(opaque);
    const auto count = std::min<std::size_t>(size, m.bytes.size() - m.at);
    std::memcpy(to, m.bytes.data() + m.at, count);
    m.at += count;
    return count;
  }
  static uLong write(void* opaque, void*, const void* from, uLong size) {
    auto& m = of(opaque);
    m.bytes.replace(m.at, size, static_cast<const char*>(from), size);
    m.at += size;
    return size;
  }
  static ZPOS64_T tell(void* opaque, void*) { return of(opaque).at; }
  static long seek(void* opaque, void*, ZPOS64_T offset, int origin) {
    auto& m = of(opaque);
    const std::size_t from = origin == ZLIB_FILEFUNC_SEEK_CUR   ? m.at
                             : origin == ZLIB_FILEFUNC_SEEK_END ? m.bytes.size()
                                                                : 0;
    if (from + offset > m.bytes.size()) return -1;
    m.at = from + offset;
    return 0;
  }
  static int close(void*, void*) { return 0; }
  static int error(void*, void*) { return 0; }
};

namespace {

int close(void* zip) { return zipClose(zip, nullptr); }

void demand(int status) {
  if (status != ZIP_OK) throw std::runtime_error("minizip: status " + std::to_string(status));
}

}  // namespace

ZipArchive::ZipArchive() : memory_(std::make_unique<ZipMemory>()), zip_(nullptr, &close) {
  zlib_filefunc64_def to{.zopen64_file = &ZipMemory::open,
                         .zread_file = &ZipMemory::read,
                         .zwrite_file = &ZipMemory::write,
                         .ztell64_file = &ZipMemory::tell,
                         .zseek64_file = &ZipMemory::seek,
                         .zclose_file = &ZipMemory::close,
                         .zerror_file = &ZipMemory::error,
                         .opaque = memory_.get()};
  zip_.reset(zipOpen2_64("", APPEND_STATUS_CREATE, nullptr, &to));
  if (zip_ == nullptr) throw std::runtime_error("minizip opens no archive");
}

ZipArchive::~ZipArchive() = default;

void ZipArchive::add(const std::string& name, std::string_view bytes) {
  constexpr uLong kDeflate20 = 20, kUtf8 = 1UL << 11;     // of the format: version, flag
  constexpr uLong kEarliest = (1UL << 21) | (1UL << 16);  // 1980-01-01 in MS-DOS's bits
  constexpr std::size_t kPiece = 1U << 16;                // some 2 ms of deflate
  constexpr uInt kNoCrc = 0;
  zip_fileinfo about{};
  about.dosDate = kEarliest;
  demand(zipOpenNewFileInZip4_64(zip_.get(), name.c_str(), &about, nullptr, 0, nullptr, 0, nullptr,
                                 Z_DEFLATED, Z_DEFAULT_COMPRESSION, 0, -MAX_WBITS, DEF_MEM_LEVEL,
                                 Z_DEFAULT_STRATEGY, nullptr, kNoCrc, kDeflate20, kUtf8, 0));
  while (!bytes.empty()) {
    ask();
    const auto piece = bytes.substr(0, kPiece);
    demand(zipWriteInFileInZip(zip_.get(), piece.data(), static_cast<unsigned>(piece.size())));
    bytes.remove_prefix(piece.size());
  }
  demand(zipCloseFileInZip(zip_.get()));
}

std::string ZipArchive::take() {
  demand(zipClose(zip_.release(), nullptr));
  return std::move(memory_->bytes);
}

}  // namespace tubecut::api
