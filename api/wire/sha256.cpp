#include "api/wire/sha256.hpp"

#include <openssl/evp.h>

#include <stdexcept>

#include "api/stop.hpp"

namespace tubecut::api {
namespace {

void must(int done) {
  if (done != 1) throw std::runtime_error("SHA-256 is not available");
}

/// Looked up once: by name it costs more than to hash a kilobyte.
const EVP_MD* algorithm() {
  static const EVP_MD* const fetched = EVP_MD_fetch(nullptr, "SHA256", nullptr);
  return fetched;
}

}  // namespace

Sha256::Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
  must(EVP_DigestInit_ex(context_.get(), algorithm(), nullptr));
}

void Sha256::add(std::string_view bytes) {
  must(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()));
}

std::string Sha256::hex() {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int length = 0;
  must(EVP_DigestFinal_ex(context_.get(), digest, &length));
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out;
  for (unsigned int i = 0; i < length; ++i) {
    out += kHex[digest[i] >> 4];
    out += kHex[digest[i] & 15];
  }
  return out;
}

std::string sha256(std::string_view bytes) {
  constexpr std::size_t kAtOnce = 256u << 10;
  Sha256 out;
  for (std::size_t at = 0; at < bytes.size(); at += kAtOnce) {
    ask();
    out.add(bytes.substr(at, kAtOnce));
  }
  return out.hex();
}

}  // namespace tubecut::api
