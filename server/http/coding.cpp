#include "server/http/coding.hpp"

#define ZLIB_CONST  // what it compresses is not its own

#include <fmt/format.h>
#include <openssl/sha.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <new>
#include <string>

#include "api/wire/header_list.hpp"

namespace tubecut::server {
namespace {

constexpr std::size_t kWorthIt = 4096;  // bytes; smaller bodies fit into three packets
constexpr std::size_t kTagBytes = 16;   // of the hash
constexpr std::array kPacked = {"application/zip", "application/pdf"};

std::string tag_of(const std::string& body) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> hash{};
  SHA256(reinterpret_cast<const unsigned char*>(body.data()), body.size(), hash.data());
  std::string out = "\"";
  for (std::size_t i = 0; i < kTagBytes; ++i)
    fmt::format_to(std::back_inserter(out), "{:02x}", hash.at(i));
  return out + '"';
}

/// If-None-Match compares weakly (RFC 9110, 13.1.2).
bool has_it(const Request& request, std::string_view tag) {
  const auto known = header(request.headers, "If-None-Match");
  return known == "*" || known.find(tag) != std::string_view::npos;
}

std::string gzip(std::string_view plain) {
  constexpr int kGzip = 16 + MAX_WBITS;  // zlib's way to say that it is no stream of its own format
  constexpr int kMemory = 8;             // zlib's own choice
  z_stream stream{};
  // The fastest level, because numbers in text shrink to a third at any level.
  if (deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string out(deflateBound(&stream, static_cast<uLong>(plain.size())), '\0');
  stream.next_in = reinterpret_cast<const Bytef*>(plain.data());
  stream.avail_in = static_cast<uInt>(plain.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int end = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (end != Z_STREAM_END) throw std::bad_alloc();
  return out;
}

}  // namespace

bool takes_gzip(const Request& request) {
  return std::ranges::any_of(
      api::header_list(header(request.headers, "Accept-Encoding")),
      [](const auto& coding) { return coding.name == "gzip" && coding.quality > 0.0; });
}

void revalidate(const Request& request, Response& response) {
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (!reads || response.status != 200) return;
  const auto tag = tag_of(response.body);
  response.headers.emplace_back("ETag", "W/" + tag);  // weak: one tag for every coding
  response.headers.emplace_back("Cache-Control", "no-cache");
  if (!has_it(request, tag)) return;
  response.status = 304;
  response.content_type.clear();
  response.body.clear();
}

void compress(const Request& request, Response& response) {
  if (response.body.size() <= kWorthIt || !response.lines.empty()) return;
  if (std::ranges::find(kPacked, response.content_type) != kPacked.end()) return;
  response.headers.emplace_back("Vary", "Accept-Encoding");
  if (!takes_gzip(request)) return;
  response.body = gzip(response.body);
  response.headers.emplace_back("Content-Encoding", "gzip");
}

}  // namespace tubecut::server
