#include "server/http/static_files.hpp"

#define ZLIB_CONST  // makes zlib's input pointer const

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>

#include "server/http/coding.hpp"

namespace tubecut::server {
namespace {

constexpr std::string_view kHtml = "text/html; charset=utf-8";

/// Nothing from elsewhere, nothing inline, no frames, no text run as script; the console compiles
/// the WebAssembly that reads IFC files. The API reference sets styles on its elements and contains
/// its icons as data.
constexpr std::string_view kPolicy =
    "default-src 'none'; "
    "script-src 'self' 'wasm-unsafe-eval'; "
    "style-src 'self'; "
    "img-src 'self'; "
    "connect-src 'self'; "
    "base-uri 'none'; "
    "form-action 'none'; "
    "frame-ancestors 'none'";
constexpr std::string_view kDocsPolicy =
    "default-src 'none'; "
    "script-src 'self'; "
    "style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data:; "
    "connect-src 'self'; "
    "base-uri 'none'; "
    "form-action 'none'; "
    "frame-ancestors 'none'";

constexpr StaticFile kNoConsole = {
    .path = "/",
    .content_type = kHtml,
    .etag = "\"no-console\"",
    .plain =
        "<!doctype html><html lang=\"en\"><title>tubecut</title><h1>tubecut</h1>"
        "<p>This binary was built without the console (./dev build makes it where Node.js is)."
        "</p><p>The API is here: <a href=\"/openapi.yaml\">openapi.yaml</a>, "
        "<a href=\"/v1/examples\">examples</a>.</p></html>\n",
    .gzip = {}};

/// A folder's page also answers with a slash at the end.
std::string_view named(std::string_view path) {
  return path.size() > 1 && path.ends_with('/') ? path.substr(0, path.size() - 1) : path;
}

const StaticFile* find(std::string_view path, std::span<const StaticFile> files) {
  const auto found = std::ranges::find(files, path, &StaticFile::path);
  if (found != files.end()) return &*found;
  return files.empty() && (path == "/" || path == "/docs") ? &kNoConsole : nullptr;
}

std::string unpack(const StaticFile& file) {
  constexpr int kGzip = 16 + MAX_WBITS;  // selects the gzip format in zlib
  std::string plain(file.bytes, '\0');
  z_stream stream{};
  if (inflateInit2(&stream, kGzip) != Z_OK) throw std::bad_alloc();
  stream.next_in = reinterpret_cast<const Bytef*>(file.gzip.data());
  stream.avail_in = static_cast<uInt>(file.gzip.size());
  stream.next_out = reinterpret_cast<Bytef*>(plain.data());
  stream.avail_out = static_cast<uInt>(plain.size());
  const bool whole = inflate(&stream, Z_FINISH) == Z_STREAM_END && stream.avail_out == 0;
  inflateEnd(&stream);
  if (!whole) throw std::runtime_error(fmt::format("{} does not unpack", file.path));
  return plain;
}

std::string_view unpacked(const StaticFile& file) {
  static std::mutex one_at_a_time;
  static std::map<std::string_view, std::string> kept;  // by the ETag, the hash of the content
  const std::lock_guard lock(one_at_a_time);
  const auto found = kept.find(file.etag);
  return found != kept.end() ? found->second : kept.emplace(file.etag, unpack(file)).first->second;
}

Headers headers_of(const StaticFile& file, bool packed) {
  Headers headers{
      {"ETag", std::string(file.etag)},
      {"Cache-Control", file.immutable ? "public, max-age=31536000, immutable" : "no-cache"},
      {"Vary", "Accept-Encoding"},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"}};
  if (packed) headers.emplace_back("Content-Encoding", "gzip");
  if (file.content_type == kHtml) {
    headers.emplace_back("Content-Security-Policy", file.path == "/docs" ? kDocsPolicy : kPolicy);
  }
  return headers;
}

}  // namespace

std::optional<Response> static_answer(const Request& request, std::span<const StaticFile> files) {
  if (request.refusal || (request.method != "GET" && request.method != "HEAD")) return std::nullopt;
  const StaticFile* file = find(named(path_of(request.target)), files);
  if (file == nullptr) return std::nullopt;
  const bool packed = !file->gzip.empty() && takes_gzip(request);
  Response response{.status = 200,
                    .content_type = std::string(file->content_type),
                    .headers = headers_of(*file, packed),
                    .body = {}};
  if (header(request.headers, "If-None-Match") == file->etag) {
    response.status = 304;
    return response;
  }
  response.fixed = packed ? file->gzip : file->gzip.empty() ? file->plain : unpacked(*file);
  return response;
}

}  // namespace tubecut::server
