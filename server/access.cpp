#include "server/access.hpp"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/sha.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

#include "api/wire/header_list.hpp"
#include "server/http/networks.hpp"
#include "server/identity.hpp"

namespace tubecut::server {
namespace {

using Digest = std::array<std::uint8_t, 32>;

constexpr double kBurstSeconds = 1.0;  // of the rate, kept for use at once; at least one request

Digest digest(std::string_view text) {
  Digest out{};
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  SHA256(bytes.data(), bytes.size(), out.data());
  return out;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

std::optional<Digest> from_hex(std::string_view text) {
  Digest out{};
  if (text.size() != 2 * out.size()) return std::nullopt;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const int high = hex_digit(text[2 * i]);
    const int low = hex_digit(text[2 * i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    out[i] = static_cast<std::uint8_t>(16 * high + low);
  }
  return out;
}

std::string to_hex(const Digest& bytes) {
  std::string out;
  for (const auto byte : bytes) fmt::format_to(std::back_inserter(out), "{:02x}", byte);
  return out;
}

tl::expected<ApiKey, std::string> parse_key(const std::string& line) {
  std::istringstream words(line);
  std::string hash;
  std::string more;
  ApiKey key;
  words >> key.identity >> hash;
  const auto bytes = from_hex(hash);
  if (!sound_identity(key.identity))
    return tl::unexpected(std::string("an identity is letters, digits, . _ -"));
  if (!bytes)
    return tl::unexpected(std::string("a key is given as its SHA-256 in 64 lower-case hex digits"));
  key.sha256 = *bytes;
  if (!(words >> std::ws).eof() && !(words >> key.per_second && key.per_second > 0.0)) {
    return tl::unexpected(std::string("a rate is a number of requests per second above 0"));
  }
  words.clear();
  if (words >> more) return tl::unexpected(std::string("there are more than three words"));
  return key;
}

std::string sent_key(const Headers& headers) {
  constexpr std::string_view kScheme = "Bearer ";
  const auto authorization = header(headers, "Authorization");
  if (equal_ignoring_case(authorization.substr(0, kScheme.size()), kScheme)) {
    return std::string(authorization.substr(kScheme.size()));
  }
  return std::string(header(headers, "X-Api-Key"));
}

}  // namespace

tl::expected<std::vector<ApiKey>, std::string> parse_keys(std::string_view text) {
  std::vector<ApiKey> keys;
  std::istringstream in{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    auto key = parse_key(line);
    if (!key) return tl::unexpected(fmt::format("line {}: {}", number, key.error()));
    keys.push_back(*std::move(key));
  }
  if (keys.empty()) return tl::unexpected(std::string("there is no key in it"));
  return keys;
}

std::string Access::load() {
  if (file_.empty()) return {};
  std::error_code unknown;
  if (std::filesystem::is_directory(file_, unknown))
    return fmt::format("cannot read the keys in {}: it is a folder", file_);
  std::ifstream in(file_, std::ios::binary);
  if (!in) return fmt::format("cannot read the keys in {}", file_);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  auto keys = parse_keys(text);
  if (!keys) return fmt::format("{}: {}", file_, keys.error());
  const std::lock_guard lock(mutex_);
  keys_ = *std::move(keys);
  std::erase_if(buckets_, [this](const auto& bucket) {
    return std::ranges::none_of(keys_,
                                [&](const ApiKey& key) { return key.identity == bucket.first; });
  });
  return {};
}

tl::expected<std::string, Refusal> Access::identify(const Headers& headers) const {
  if (file_.empty()) return std::string{};
  const auto sent = digest(sent_key(headers));
  const std::lock_guard lock(mutex_);
  const ApiKey* found = nullptr;
  for (const auto& key : keys_) {  // compares all keys, so that the time does not reveal which one
                                   // matches
    if (CRYPTO_memcmp(key.sha256.data(), sent.data(), sent.size()) == 0) found = &key;
  }
  if (found != nullptr) return found->identity;
  return tl::unexpected(Refusal{ErrorCode::unauthorized,
                                "Send a key as Authorization: Bearer KEY or X-Api-Key: KEY."});
}

std::optional<Refusal> Access::take_rate_token(const std::string& identity, double now) {
  const std::lock_guard lock(mutex_);
  const auto key =
      std::ranges::find_if(keys_, [&](const ApiKey& k) { return k.identity == identity; });
  if (key == keys_.end() || key->per_second == 0.0) return std::nullopt;
  const double most = std::max(1.0, kBurstSeconds * key->per_second);
  auto [at, fresh] = buckets_.try_emplace(identity, Bucket{.tokens = most, .filled_at = now});
  Bucket& bucket = at->second;
  bucket.tokens = std::min(most, bucket.tokens + (now - bucket.filled_at) * key->per_second);
  bucket.filled_at = now;
  if (bucket.tokens >= 1.0) {
    bucket.tokens -= 1.0;
    return std::nullopt;
  }
  const double wait = (1.0 - bucket.tokens) / key->per_second;
  return Refusal{ErrorCode::rate_limited,
                 fmt::format("This key may send {} requests per second.", key->per_second),
                 std::max(1, static_cast<int>(std::ceil(wait)))};
}

bool sound_identity(std::string_view name) {
  return !name.empty() && name.size() <= 64 && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  });
}

NewKey make_key(const std::string& identity) {
  NewKey out{.key = "tc_" + random_id() + random_id(), .line = {}};
  out.line = identity + " " + to_hex(digest(out.key));
  return out;
}

bool is_origin(std::string_view text) {
  const auto scheme = text.find("://");
  if (scheme == std::string_view::npos || scheme == 0) return false;
  const auto host = text.substr(scheme + 3);
  const auto fit = [](std::string_view part, std::string_view marks) {
    return !part.empty() && std::ranges::all_of(part, [&](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || marks.find(c) != marks.npos;
    });
  };
  return fit(text.substr(0, scheme), "+-.") && fit(host, "-._:[]");
}

std::string client_of(const Request& request, const std::vector<std::string>& proxies) {
  std::string client = request.peer;
  std::vector<api::ListElement> hops;
  for (const auto value : header_values(request.headers, "X-Forwarded-For"))
    std::ranges::move(api::header_list(value), std::back_inserter(hops));
  for (; !hops.empty() && in_networks(client, proxies); hops.pop_back()) {
    std::string last(hops.back().name);
    if (!is_address(last)) break;  // trust only addresses that our own proxies wrote
    client = std::move(last);
  }
  return client;
}

}  // namespace tubecut::server
