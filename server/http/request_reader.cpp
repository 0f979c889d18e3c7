// The one source that includes Boost.Beast: its parser reads the bytes, framing.hpp judges them.

#include "server/http/request_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/beast/http/basic_parser.hpp>
#include <limits>
#include <optional>

#include "server/http/framing.hpp"
#include "server/http/memory_share.hpp"

namespace tubecut::server {
namespace {

namespace http = boost::beast::http;
using Text = boost::beast::string_view;
using Code = boost::beast::error_code;

constexpr std::size_t kLineBytes = 4096;  // a chunk's line, or the trailer section
constexpr std::size_t kChunkOverhead =
    65536;  // framing bytes a chunked body may add to twice its size
/// A chunked body ends with at least this many bytes; Beast 1.74 asserts that it gets them.
constexpr std::size_t kShortestEnd = std::string_view("0\r\n\r\n").size();
/// Growth of a body's buffer relative to the bytes received. Twice would be enough, but while the
/// buffer moves, the old one still exists.
constexpr std::size_t kReadAhead = 8;
constexpr std::size_t kEmptyLines = 8;  // bytes of CR LF before a request line (RFC 9112, 2.2)

std::string_view view(Text text) { return {text.data(), text.size()}; }

/// Collects the parts that Beast finds. Trailer fields are read and dropped.
class Parser final : public http::basic_parser<true> {
 public:
  explicit Parser(std::size_t most_fields) : most_fields_(most_fields) {
    header_limit(std::numeric_limits<std::uint32_t>::max());  // the head is bounded by its owner
    // Not boost::none, because 1.74 then treats every Content-Length as too large.
    body_limit(std::numeric_limits<std::uint64_t>::max());
    eager(true);
  }

  Request request = {};
  int minor = 1;
  bool too_many_fields = false;
  bool head_done = false;
  std::size_t announced = 0;  // bytes of body

 private:
  void on_request_impl(http::verb /*verb*/, Text method, Text target, int version,
                       Code& ec) override {
    request.method = view(method);
    request.target = view(target);
    minor = version - 10;
    if (version != 10 && version != 11) ec = http::error::bad_version;
  }
  void on_response_impl(int /*status*/, Text /*reason*/, int /*version*/, Code& /*ec*/) override {}
  void on_field_impl(http::field /*field*/, Text name, Text value, Code& ec) override {
    if (head_done) return;
    if (request.headers.size() == most_fields_) {
      too_many_fields = true;
      ec = http::error::header_limit;
      return;
    }
    request.headers.emplace_back(view(name), view(value));
  }
  void on_header_impl(Code& /*ec*/) override { head_done = true; }
  void on_body_init_impl(const boost::optional<std::uint64_t>& /*length*/, Code& /*ec*/) override {}
  std::size_t on_body_impl(Text bytes, Code& /*ec*/) override { return append(bytes); }
  void on_chunk_header_impl(std::uint64_t /*size*/, Text /*extensions*/, Code& /*ec*/) override {}
  std::size_t on_chunk_body_impl(std::uint64_t /*left*/, Text bytes, Code& /*ec*/) override {
    return append(bytes);
  }
  void on_finish_impl(Code& /*ec*/) override {}

  /// An announced length takes no memory before its bytes come: at most kReadAhead times theirs,
  /// and in the end its own.
  std::size_t append(Text bytes) {
    const auto needed = request.body.size() + bytes.size();
    if (needed > request.body.capacity()) {
      auto room = std::max(announced, needed);
      while (room / kReadAhead >= needed) room = (room + kReadAhead - 1) / kReadAhead;
      request.body.reserve(room);
    }
    request.body.append(bytes.data(), bytes.size());
    return bytes.size();
  }

  std::size_t most_fields_;
};

std::string reason(const Code& ec, bool too_many_fields) {
  if (too_many_fields) return "The head has too many fields.";
  if (ec == http::error::bad_content_length) {
    return "Content-Length is not a whole number, or another length is sent too.";
  }
  if (ec == http::error::bad_transfer_encoding) {
    return "Transfer-Encoding is sent together with another length.";
  }
  if (ec == http::error::bad_version) return "The version is neither HTTP/1.1 nor HTTP/1.0.";
  return fmt::format("The request's head is malformed ({}).", ec.message());
}

}  // namespace

struct RequestReader::Impl {
  explicit Impl(const ReaderLimits& of) : limits(of), parser(of.fields) {}

  std::size_t fail(ErrorCode code, std::string detail, std::size_t taken) {
    state = State::faulty;
    fault = {code, std::move(detail)};
    return taken;
  }
  std::size_t malformed(std::string_view detail, std::size_t taken) {
    return fail(ErrorCode::bad_request, std::string(detail), taken);
  }

  std::size_t take_head(std::string_view in);
  std::size_t read_head(std::string_view bytes, std::size_t taken);
  std::size_t take_body(std::string_view in);
  void judge_body(const Code& ec, bool stuck);

  ReaderLimits limits;
  Parser parser;
  State state = State::head;
  Refusal fault;
  std::string head;  // not yet whole
  std::size_t head_length = 0;
  std::size_t empty = 0;  // bytes of empty lines passed over
  std::size_t body_limit = 0;
  std::size_t on_wire = 0;  // bytes of a chunked body with its framing
};

/// Gives the parser a whole head at a time, so that its bytes are checked before the parser
/// normalises them.
std::size_t RequestReader::Impl::take_head(std::string_view in) {
  std::size_t skipped = 0;
  while (head.empty() && skipped < in.size() && (in[skipped] == '\r' || in[skipped] == '\n')) {
    ++skipped;
    if (++empty > kEmptyLines) return malformed("Too many empty lines before a request.", skipped);
  }
  in.remove_prefix(skipped);
  const std::size_t before = head.size();
  const std::size_t from = before < 3 ? 0 : before - 3;
  head.append(in.substr(0, limits.head_bytes + 4 - std::min(before, limits.head_bytes)));
  const auto end = head.find("\r\n\r\n", from);
  const std::size_t length = end == std::string::npos ? head.size() : end + 4;
  // The last byte of an unfinished head is checked together with the next one.
  const std::size_t judged = end == std::string::npos && length > 0 ? length - 1 : length;
  const std::size_t unjudged = before < 2 ? 0 : before - 1;
  if (const auto wrong = byte_fault({head.data(), length}, unjudged, judged); !wrong.empty()) {
    return malformed(wrong, skipped + length - before);
  }
  if (length > limits.head_bytes) {
    return malformed(fmt::format("The head is longer than {} bytes.", limits.head_bytes),
                     skipped + length - before);
  }
  if (end == std::string::npos) return skipped + length - before;
  return read_head(std::string_view(head).substr(0, length), skipped + length - before);
}

std::size_t RequestReader::Impl::read_head(std::string_view bytes, std::size_t taken) {
  Code ec;
  parser.put(boost::asio::const_buffer(bytes.data(), bytes.size()), ec);
  if (ec || !parser.head_done) return malformed(reason(ec, parser.too_many_fields), taken);
  Request& request = parser.request;
  if (const auto wrong = framing_fault(request.headers, parser.minor); !wrong.empty()) {
    return malformed(wrong, taken);
  }
  auto target = origin_form(request.target, request.method);
  if (target.empty()) return malformed("The target is not a path of this service.", taken);
  request.target = std::move(target);
  give_back(head);
  head_length = bytes.size();
  state = parser.is_done() ? State::whole : State::body;
  return taken;
}

/// Passes slices, so that a chunk's line or the trailers are refused only by their length, for any
/// arrival pattern.
std::size_t RequestReader::Impl::take_body(std::string_view in) {
  std::size_t taken = 0;
  while (taken < in.size() && state == State::body) {
    if (parser.chunked() && in.size() - taken < kShortestEnd) break;
    const auto slice = in.substr(taken, parser.chunked() ? kLineBytes : in.size());
    Code ec;
    const auto n = parser.put(boost::asio::const_buffer(slice.data(), slice.size()), ec);
    taken += n;
    on_wire += n;
    judge_body(ec, n == 0 && slice.size() == kLineBytes);
    if (n == 0) break;
  }
  return taken;
}

void RequestReader::Impl::judge_body(const Code& ec, bool stuck) {
  if (ec == http::error::body_limit || parser.request.body.size() > body_limit) {
    fail(ErrorCode::body_too_large, fmt::format("The body is larger than {} bytes.", body_limit),
         0);
  } else if (parser.is_done()) {
    state = State::whole;
  } else if ((ec && ec != http::error::need_more) ||
             (parser.chunked() && (stuck || on_wire > 2 * body_limit + kChunkOverhead))) {
    malformed("The chunks of the body are malformed.", 0);
  }
}

RequestReader::RequestReader(const ReaderLimits& limits) : x_(std::make_unique<Impl>(limits)) {}
RequestReader::~RequestReader() = default;
RequestReader::RequestReader(RequestReader&&) noexcept = default;
RequestReader& RequestReader::operator=(RequestReader&&) noexcept = default;

std::size_t RequestReader::take(std::string_view in) {
  if (in.empty()) return 0;
  if (x_->state == State::head) return x_->take_head(in);
  return x_->state == State::body ? x_->take_body(in) : 0;
}

RequestReader::State RequestReader::state() const { return x_->state; }

void RequestReader::allow_body(std::size_t bytes) {
  x_->body_limit = bytes;
  x_->parser.body_limit(bytes);
  x_->parser.announced = static_cast<std::size_t>(std::min<std::uint64_t>(content_length(), bytes));
}

Request& RequestReader::request() { return x_->parser.request; }
const Refusal& RequestReader::fault() const { return x_->fault; }
bool RequestReader::chunked() const { return x_->parser.chunked(); }
std::uint64_t RequestReader::content_length() const {
  return announced_length(x_->parser.request.headers);
}

bool RequestReader::expects_continue() const {
  return x_->parser.minor > 0 && lists_token(x_->parser.request.headers, "Expect", "100-continue");
}

bool RequestReader::takes_chunks() const { return x_->parser.minor > 0; }

bool RequestReader::keeps_alive() const {
  const auto& headers = x_->parser.request.headers;
  if (lists_token(headers, "Connection", "close")) return false;
  return x_->parser.minor > 0;
}

std::size_t RequestReader::held() const {
  const auto taken = [](const std::string& text) { return text.empty() ? 0 : text.capacity(); };
  const auto head = x_->state == State::body ? x_->head_length : taken(x_->head);
  return head + taken(x_->parser.request.body);
}

}  // namespace tubecut::server
