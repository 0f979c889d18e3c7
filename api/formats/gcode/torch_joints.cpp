#include "api/formats/gcode/torch_joints.hpp"

#include <cmath>
#include <utility>

#include "api/catalog/posts.hpp"
#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/torch/torch_program.hpp"

namespace tubecut::api {
namespace {

/// Returns the axis, or a default one if it is not needed.
PostAxis needed(const Post& post, PostRole role, bool is, std::string_view option,
                std::string_view why) {
  const auto& axis = post.axis(role);
  if (axis || !is) return axis.value_or(PostAxis{});
  throw UnfitOption{option, "post " + post.name + " has no axis " +
                                kPostRoles[static_cast<std::size_t>(role)] + ", " +
                                std::string(why)};
}

}  // namespace

TorchJoints::TorchJoints(double outer_radius, const std::optional<section::Section>& section,
                         Leaning leaning, const FormatOptions& options)
    : radius_(outer_radius),
      pivot_(options.pivot_length),
      clearance_(options.clearance.value_or(torch::kClearance)),
      tilts_(leaning.across),
      has_swing_(post_of(options).axis(PostRole::swing).has_value()),
      phi_to_plus_(options.axial_z) {
  const auto& post = post_of(options);
  const auto get = [&](PostRole role, bool is, std::string_view option, std::string_view why) {
    return needed(post, role, is, option, why);
  };
  along_ = get(PostRole::along, true, "post", "");
  turn_ = get(PostRole::turn, true, "post", "");
  swing_ =
      get(PostRole::swing, leaning.along, "post",
          "that tilts the torch along the tube; if the head never tilts, use preset tube_laser");
  out_ = get(PostRole::out, pivot_ || options.axial_z, pivot_ ? "pivot_length_mm" : "axial",
             "which lifts the torch");
  tilt_ = get(PostRole::tilt, tilts_, "post", "that tilts a hole's torch across");
  across_ = get(PostRole::across, (tilts_ && pivot_) || section, "post",
                section ? "by which the torch follows the corners of a tube that is not round"
                        : "by which the pivot of a torch that leans across goes");
  if (section) {
    section_.emplace(*section);
    if (!pivot_)
      throw UnfitOption{"pivot_length_mm",
                        "the height of the wall under the torch changes, so the program moves it: "
                        "give the length, 0 if the axes carry the tip"};
    if (turn_.is_girth())
      throw UnfitOption{"post", "post " + post.name +
                                    " counts the turn of a round tube along its circumference; "
                                    "take a post whose turn is in deg or revolution"};
  }
  if (options.axial_z) std::swap(along_.letter, out_.letter);
  turn_ = turn_.on_tube(outer_radius);
}

std::string TorchJoints::words(const TorchPlace& at, double off) const {
  auto out = along_.word(along_at(at, off));
  if (moves_across()) out += " " + across_.word(across_at(at, arm(at, off)));
  if (pivot_) out += " " + height(at, off);
  return out + angles(at);
}

std::string TorchJoints::level_words(const TorchPlace& at, double off) const {
  auto out = along_.word(along_at(at, off));
  if (moves_across()) out += " " + across_.word(across_at(at, arm(at, off)));
  return out + angles(at);
}

std::string TorchJoints::height(const TorchPlace& at, double off) const {
  return out_.word(under(at).out + arm(at, off).out);
}

std::string TorchJoints::clear_height() const {
  const double highest = section_ ? section_->section().reach() : radius_;
  return out_.word(highest + *pivot_ + clearance_);
}

TorchJoints::Under TorchJoints::under(const TorchPlace& at) const {
  if (!section_) return {radius_, 0.0, at.phi * kDegPerRad};
  const auto up = section_->at(at);
  return {up.out, up.across, up.angle * kDegPerRad};
}

double TorchJoints::along_at(const TorchPlace& at, double off) const {
  return at.z + arm(at, off).along;
}

double TorchJoints::distance(const TorchPlace& from, double from_off, const TorchPlace& to,
                             double to_off) const {
  const auto a = all(from, from_off), b = all(to, to_off);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (b[i] - a[i]) * (b[i] - a[i]);
  return std::sqrt(sum);
}

double TorchJoints::rounding(double wall) const {
  const double arm = pivot_.value_or(0.0) + wall;
  double out = along_.rounding() + radius_ * turn_.rounding() * kRadPerDeg;
  if (pivot_) out += out_.rounding();
  if (section_)
    out += across_.rounding() +
           (section_->section().reach() - radius_) * turn_.rounding() * kRadPerDeg;
  if (has_swing_) out += arm * swing_.rounding() * kRadPerDeg;
  if (tilts_) out += arm * tilt_.rounding() * kRadPerDeg + (pivot_ ? across_.rounding() : 0.0);
  constexpr double kLeaning = 2.0;  // of an edge that the torch meets under 60 deg
  return has_swing_ || tilts_ ? kLeaning * out : out;
}

std::vector<TorchJoints::Shown> TorchJoints::shown(const TorchPlace& at, double off) const {
  const auto reach = arm(at, off);
  std::vector<Shown> out{{&along_, false, at.z + reach.along}};
  const auto wall = under(at);
  if (moves_across()) out.push_back({&across_, false, across_at(at, reach)});
  if (pivot_) out.push_back({&out_, false, wall.out + reach.out});
  out.push_back({&turn_, true, wall.turn});
  if (has_swing_) out.push_back({&swing_, true, at.b * kDegPerRad});
  if (tilts_) out.push_back({&tilt_, true, at.a * kDegPerRad});
  return out;
}

std::vector<AxisMove> TorchJoints::moves(const TorchPlace& from, double from_off,
                                         const TorchPlace& to, double to_off) const {
  const auto a = shown(from, from_off), b = shown(to, to_off);
  std::vector<AxisMove> out;
  for (std::size_t i = 0; i < a.size(); ++i)
    out.push_back({.letter = a[i].axis->letter,
                   .turns = a[i].turns && !a[i].axis->is_straight(),
                   .way = b[i].axis->written(b[i].value) - a[i].axis->written(a[i].value)});
  return out;
}

TorchJoints::Arm TorchJoints::arm(const TorchPlace& at, double off) const {
  if (!pivot_) return {0.0, 0.0, 0.0};
  // The torch's line: 1 outwards, tan a round, tan b along.
  const double round = elementary::tan(at.a), rise = elementary::tan(at.b);
  const double out = (*pivot_ + off) / std::sqrt(1.0 + round * round + rise * rise);
  return {out, out * rise, out * round};
}

std::string TorchJoints::angles(const TorchPlace& at) const {
  auto out = " " + turn_.word(under(at).turn);
  if (has_swing_) out += " " + swing_.word(at.b * kDegPerRad);
  if (tilts_) out += " " + tilt_.word(at.a * kDegPerRad);
  return out;
}

std::vector<double> TorchJoints::all(const TorchPlace& at, double off) const {
  const auto reach = arm(at, off);
  const auto wall = section_ ? under(at) : Under{0.0, 0.0, at.phi * kDegPerRad};
  return {along_.scale * (at.z + reach.along),        out_.scale * (wall.out + reach.out),
          across_.scale * (wall.round + reach.round), turn_.scale * wall.turn,
          swing_.scale * at.b * kDegPerRad,           tilt_.scale * at.a * kDegPerRad};
}

}  // namespace tubecut::api
