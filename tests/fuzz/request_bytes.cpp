#include "tests/fuzz/request_bytes.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/request_reader.hpp"

namespace tubecut::fuzz {
namespace {

using server::RequestReader;
using State = RequestReader::State;

constexpr std::size_t kBody = 4096;
constexpr server::ReaderLimits kLimits{.head_bytes = 1024, .fields = 16};

[[noreturn]] void broken(const char* promise) {
  std::fprintf(stderr, "broken: %s\n", promise);
  std::abort();
}

void check(RequestReader& reader) {
  const auto& request = reader.request();
  if (request.body.size() > kBody) broken("a body beyond its limit");
  if (request.headers.size() > kLimits.fields) broken("fields beyond their limit");
  if (request.target.empty() || (request.target[0] != '/' && request.target != "*")) {
    broken("a target that is no path");
  }
  if (server::header_values(request.headers, "Host").size() > 1) broken("two hosts");
  const auto lengths = server::header_values(request.headers, "Content-Length").size();
  const auto codings = server::header_values(request.headers, "Transfer-Encoding").size();
  if (lengths + codings > 1) broken("two lengths");
  if (!reader.chunked() && request.body.size() != reader.content_length()) {
    broken("a body of another length than announced");
  }
  for (const auto& [name, value] : request.headers) {
    if ((name + value).find_first_of(std::string_view("\r\n\0", 3)) != std::string::npos) {
      broken("a line end inside a field");
    }
  }
}

/// The output as text: requests in order, then how it ended.
std::string read(std::string_view bytes, std::size_t piece) {
  std::string story;
  RequestReader reader(kLimits);
  std::string held;
  bool allowed = false;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    held.append(bytes.substr(at, piece));
    for (bool on = true; on && !held.empty();) {
      const auto taken = reader.take(held);
      if (taken > held.size()) broken("more taken than given");
      held.erase(0, taken);
      on = taken > 0;
      if (reader.state() == State::body && !allowed) {
        reader.allow_body(kBody);
        allowed = on = true;
        if (!reader.chunked() && reader.content_length() > kBody) return story + "too large";
      } else if (reader.state() == State::whole) {
        check(reader);
        story += reader.request().method + " " + reader.request().target + " " +
                 reader.request().body + "\n";
        reader = RequestReader(kLimits);
        allowed = false;
        on = true;
      } else if (reader.state() == State::faulty) {
        return story + "fault";
      }
    }
    if (held.size() > 3 * 8192) broken("bytes kept beyond a chunk's line");
  }
  return story;
}

/// Beast looks for the end of a quoted chunk extension beyond its line: whether a line that is
/// never accepted is a fault at once or after more bytes depends on the pieces. The requests read
/// do not.
std::string without_fault(std::string story) {
  constexpr std::string_view kFault = "fault";
  if (story.ends_with(kFault)) story.resize(story.size() - kFault.size());
  return story;
}

}  // namespace

void request_bytes(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || bytes.size() > 16384) return;
  const std::string text(bytes.begin() + 1, bytes.end());
  const std::string whole = without_fault(read(text, std::max<std::size_t>(1, text.size())));
  const std::string pieces = without_fault(read(text, 1 + bytes[0] % 16));
  if (whole != pieces) broken("the pieces it came in change what is read");
}

}  // namespace tubecut::fuzz
