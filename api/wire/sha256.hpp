#pragma once

#include <memory>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // of OpenSSL

namespace tubecut::api {

/// SHA-256 of the added parts. Throws std::runtime_error if OpenSSL does not offer it.
class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// Returns lower-case hex; add nothing after it.
  [[nodiscard]] std::string hex();

 private:
  std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

/// sha256 in lower-case hex. Throws Stopped.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace tubecut::api
