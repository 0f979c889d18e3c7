#include "api/sha256.hpp"

#include <openssl/evp.h>

#include <memory>
#include <stdexcept>

#include "api/stop.hpp"

namespace tubecut::api {

std::string sha256(std::string_view bytes, const std::stop_token& stop) {
  constexpr std::size_t kAtOnce = 256u << 10;
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(),
                                                                        &EVP_MD_CTX_free);
  bool sound = EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
  for (std::size_t at = 0; sound && at < bytes.size(); at += kAtOnce) {
    ask(stop);
    const auto part = bytes.substr(at, kAtOnce);
    sound = EVP_DigestUpdate(context.get(), part.data(), part.size()) == 1;
  }
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int length = 0;
  if (!sound || EVP_DigestFinal_ex(context.get(), digest, &length) != 1)
    throw std::runtime_error("SHA-256 is not available");
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out;
  for (unsigned int i = 0; i < length; ++i) {
    out += kHex[digest[i] >> 4];
    out += kHex[digest[i] & 15];
  }
  return out;
}

}  // namespace tubecut::api
