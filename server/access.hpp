#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "server/http/http.hpp"

namespace tubecut::server {

/// One line of the file of API keys. The key itself is nowhere: 256 random bits need no slow hash.
struct ApiKey {
  std::string identity;  // for the log and the rate
  std::array<std::uint8_t, 32> sha256 = {};
  double per_second = 0.0;  // requests; 0: no limit
};

/// Reads lines "identity sha256-in-hex [requests-per-second]"; '#' begins a comment. An error names
/// the line, never its content.
[[nodiscard]] tl::expected<std::vector<ApiKey>, std::string> parse_keys(std::string_view text);

/// Who may use the service. Without a file everybody may. Safe to call from many threads.
class Access {
 public:
  /// If the name is empty, no key is required.
  explicit Access(std::string file) : file_(std::move(file)) {}

  /// Reads the file again. Returns an error text, or an empty text. If the file has an error, the
  /// keys stay as they were.
  [[nodiscard]] std::string load();

  [[nodiscard]] bool asks() const { return !file_.empty(); }

  /// Returns the owner of the request's key (`Authorization: Bearer KEY` or `X-Api-Key: KEY`), or
  /// an empty identity if no keys are required. Takes the same time for any wrong key.
  [[nodiscard]] tl::expected<std::string, Refusal> identify(const Headers& headers) const;

  /// Takes a token of the identity's rate for one request, at that monotonic time in seconds.
  [[nodiscard]] std::optional<Refusal> take_rate_token(const std::string& identity, double now);

 private:
  struct Bucket {
    double tokens = 0.0;
    double filled_at = 0.0;
  };

  std::string file_;
  mutable std::mutex mutex_;
  std::vector<ApiKey> keys_;
  std::map<std::string, Bucket> buckets_;  // one per identity of the file at most
};

/// A new key and the line that belongs in the file.
struct NewKey {
  std::string key;
  std::string line;
};
[[nodiscard]] NewKey make_key(const std::string& identity);

/// Whether a key's owner can be so named: 1 to 64 letters, digits, . _ -
[[nodiscard]] bool sound_identity(std::string_view name);

/// Whether a browser could send it as `Origin`: "https://plant.example:8443".
[[nodiscard]] bool is_origin(std::string_view text);

/// Returns the address of the client: the peer, or, if the peer is one of `proxies`, the last
/// address of X-Forwarded-For that is not.
[[nodiscard]] std::string client_of(const Request& request,
                                    const std::vector<std::string>& proxies);

}  // namespace tubecut::server
