#include "api/catalog/posts.hpp"

#include <algorithm>
#include <array>
#include <atomic>

#include "api/api.hpp"
#include "api/catalog/catalogue.hpp"
#include "api/wire/json_number.hpp"
#include "api/wire/sha256.hpp"

namespace tubecut::api {
namespace {

/// The shipped ones; the first is a program's unless it names another.
constexpr std::array kShipped{"posts/linuxcnc.json", "posts/qtplasmac.json",
                              "posts/fanuc_style.json", "posts/siemens_style.json",
                              "posts/point_pairs.json"};

const ShelfPost* find(const PostShelf& all, std::string_view name) {
  const auto found = std::ranges::find(
      all, name, [](const ShelfPost& p) -> std::string_view { return p.post.name; });
  return found == all.end() ? nullptr : &*found;
}

std::string shown(const FieldIssue& issue) {
  auto out = issue.pointer + ": " + std::string(info(issue.code).meaning);
  return issue.hint.empty() ? out : out + " (" + issue.hint + ")";
}

/// Adds the post of a JSON text; returns an error text, or an empty text.
std::string add_post(std::string_view json, PostShelf& all) {
  const auto body = parse(json);
  if (!body) return body.error().reason + " at byte " + std::to_string(body.error().offset);
  Reader in(*body);
  ShelfPost out{.post = decode_post(in), .document = {}, .sha256 = {}};
  if (const auto issues = in.finish_root(); !issues.empty()) return shown(issues.front());
  if (find(all, out.post.name) != nullptr) return "/name: there is a post of this name already";
  out.document = Json{in.take_echo()};
  Writer text;
  text.json(out.document);
  out.sha256 = sha256(text.take());
  all.push_back(std::move(out));
  return {};
}

PostShelf shipped() {
  PostShelf out;
  for (const auto* name : kShipped)
    if (const auto wrong = add_post(embedded(name), out); !wrong.empty())
      throw std::logic_error(name + (": " + wrong));
  return out;
}

std::atomic<std::shared_ptr<const PostShelf>>& shelf() {
  static std::atomic<std::shared_ptr<const PostShelf>> now(
      std::make_shared<const PostShelf>(shipped()));
  return now;
}

}  // namespace

std::shared_ptr<const PostShelf> posts() { return shelf().load(); }

std::shared_ptr<const Post> find_post(std::string_view name) {
  const auto all = posts();
  const auto* found = find(*all, name);
  return found == nullptr ? nullptr : std::shared_ptr<const Post>(all, &found->post);
}

std::shared_ptr<const Post> inline_post(std::string_view json, const std::string& pointer,
                                        std::vector<FieldIssue>& issues) {
  const auto body = parse(json);
  if (!body) {
    if (auto issue = number_issue(json)) {
      issue->pointer = pointer + issue->pointer;
      issues.push_back(*std::move(issue));
      return nullptr;
    }
    issues.push_back(
        {.code = ErrorCode::unreadable_json,
         .pointer = pointer,
         .hint = body.error().reason + " at byte " + std::to_string(body.error().offset)});
    return nullptr;
  }
  Reader in(*body);
  auto out = std::make_shared<const Post>(decode_post(in));
  for (auto& issue : in.finish_root()) {
    issue.pointer = pointer + issue.pointer;
    issues.push_back(std::move(issue));
  }
  return out;
}

const Post& post_of(const FormatOptions& options) {
  static const Post kFirst = shipped().front().post;
  return options.post != nullptr ? *options.post : kFirst;
}

std::string post_names() {
  return one_of(*posts(), [](const auto& p) { return p.post.name; });
}

void encode_post_hashes(Writer& w) {
  w.array("posts", *posts(), [](Writer& each, const ShelfPost& p) {
    each.object([&](Writer& o) {
      o.field("name", p.post.name);
      o.field("post_sha256", p.sha256);
    });
  });
}

std::string posts_page() {
  Writer out;
  out.object([](Writer& w) {
    w.array("posts", *posts(), [](Writer& each, const ShelfPost& p) {
      each.object([&](Writer& o) {
        o.field("name", p.post.name);
        o.field("post_sha256", p.sha256);
        o.field("post", p.document);
      });
    });
  });
  return out.take();
}

std::string set_posts(std::span<const FileText> texts) {
  auto all = shipped();
  for (const auto& [file, json] : texts)
    if (const auto wrong = add_post(json, all); !wrong.empty()) return file + ": " + wrong;
  shelf().store(std::make_shared<const PostShelf>(std::move(all)));
  return {};
}

}  // namespace tubecut::api
