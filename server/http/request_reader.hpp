#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

#include "server/http/http.hpp"

namespace tubecut::server {

struct ReaderLimits {
  std::size_t head_bytes = 16384;  // request line and fields
  std::size_t fields = 64;
};

/// Reads one HTTP/1.x request from bytes as they arrive, strictly: if two programs could read it in
/// two ways, it is a fault. Holds at most the head's limit and the permitted body.
class RequestReader {
 public:
  enum class State { head, body, whole, faulty };

  explicit RequestReader(const ReaderLimits& limits = {});
  ~RequestReader();
  RequestReader(RequestReader&&) noexcept;
  RequestReader& operator=(RequestReader&&) noexcept;

  /// Takes bytes from the front of `in` and returns their number; offer the rest again with the
  /// bytes that follow it. Stops at the end of the head, so that `allow_body` can be called, and at
  /// the end of the request, because later bytes belong to the next one.
  std::size_t take(std::string_view in);

  [[nodiscard]] State state() const;

  /// Largest body from now on; to be called when the state is `body`, before the next `take`.
  void allow_body(std::size_t bytes);

  /// The head's fields and target once the head is read, the body once the request is whole.
  [[nodiscard]] Request& request();
  /// Why the state is `faulty`.
  [[nodiscard]] const Refusal& fault() const;

  [[nodiscard]] bool chunked() const;
  [[nodiscard]] std::uint64_t content_length() const;  // 0 without one
  [[nodiscard]] bool expects_continue() const;
  /// Whether the client knows chunks: HTTP/1.1 and later.
  [[nodiscard]] bool takes_chunks() const;
  /// Whether the client leaves the connection open for another request.
  [[nodiscard]] bool keeps_alive() const;
  /// Returns the bytes taken from memory: for the head, and for the received part of the body. An
  /// announced length takes no memory.
  [[nodiscard]] std::size_t held() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> x_;
};

}  // namespace tubecut::server
