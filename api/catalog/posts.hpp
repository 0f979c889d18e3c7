#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "api/catalog/post.hpp"
#include "api/wire/format.hpp"
#include "api/wire/writer.hpp"

namespace tubecut::api {

/// A post that requests can name, as its file has it.
struct ShelfPost {
  Post post;
  Json document;       // with defaults applied
  std::string sha256;  // over that
};

using PostShelf = std::vector<ShelfPost>;

/// Returns the shipped posts and those of `set_posts`, in that order, as they are now; a kept shelf
/// keeps its content.
[[nodiscard]] std::shared_ptr<const PostShelf> posts();

/// Returns the post of that name; nullptr if there is no such post.
[[nodiscard]] std::shared_ptr<const Post> find_post(std::string_view name);
/// Reads a post in a request, as JSON; issues at `pointer` and below.
[[nodiscard]] std::shared_ptr<const Post> inline_post(std::string_view json,
                                                      const std::string& pointer,
                                                      std::vector<FieldIssue>& issues);
/// Of a program that names one, or the first there is.
[[nodiscard]] const Post& post_of(const FormatOptions& options);
/// All names, between bars.
[[nodiscard]] std::string post_names();

/// The member `posts`: name and hash of each.
void encode_post_hashes(Writer& w);

/// GET /v1/posts.
[[nodiscard]] std::string posts_page();

}  // namespace tubecut::api
