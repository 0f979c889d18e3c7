#include "api/formats/drawing/point_pairs.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>

#include "api/api.hpp"
#include "api/catalog/posts.hpp"
#include "api/formats/bevel_table_formats.hpp"
#include "api/formats/gcode/torch_moves.hpp"
#include "api/formats/provenance.hpp"
#include "api/stop.hpp"
#include "api/verdict.hpp"
#include "api/wire/writer.hpp"
#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

/// Rounds to 1e-6, because smaller differences have no meaning.
double brief_number(double value) {
  constexpr double kParts = 1e6;
  const double out = std::round(value * kParts) / kParts;
  return out == 0.0 ? 0.0 : out;  // no -0
}

void write_point(Writer& w, std::string_view name, double radius, double phi, double z) {
  const auto turn = elementary::sincos(phi);
  const std::array at{brief_number(radius * turn.cos), brief_number(radius * turn.sin),
                      brief_number(z)};
  w.column(name, std::span<const double>(at));
}

std::string_view what_it_does(const TorchCutPlaces& cut, std::size_t i) {
  if (i > cut.cut_last) return "lead_out";
  if (i > cut.cut_first) return "cut";
  return i == 0 ? "pierce" : "lead_in";
}

class Pairs {
 public:
  Pairs(const TorchJob& job, const Caption& caption)
      : job_(job),
        caption_(caption),
        reach_{.outer_radius = job.outer_radius,
               .inner_radius = job.outer_radius - job.wall,
               .pivot = 0.0} {}

  void write_cut(Writer& w, const TorchCutPlaces& cut) const {
    w.object([&](Writer& o) {
      o.field("name", cut.name);
      o.field("kerf_mm", cut.kerf);
      o.field("lead_radius_mm", brief_number(cut.radius));
      o.field("torch_on_at", 0);
      o.field("torch_off_at", cut.places.size() - 1);
      std::vector<std::size_t> places(cut.places.size());
      for (std::size_t i = 0; i < places.size(); ++i) places[i] = i;
      o.array("pairs", places, [&](Writer& each, std::size_t i) { write_pair(each, cut, i); });
    });
  }

 private:
  void write_pair(Writer& w, const TorchCutPlaces& cut, std::size_t i) const {
    ask();
    const auto& at = cut.places[i];
    const auto inner = inner_place(reach_, at);
    if (!inner)
      throw UnfitOption{"post", "the torch grazes the inner wall, where there is no point of it"};
    w.object([&](Writer& o) {
      o.field("does", what_it_does(cut, i));
      write_point(o, "outer_mm", reach_.outer_radius, at.phi, at.z);
      write_point(o, "inner_mm", reach_.inner_radius, inner->phi, inner->z);
      o.field("phi_deg", brief_number(at.phi * kDegPerRad));
      o.field("b_deg", brief_number(at.b * kDegPerRad));
      o.field("a_deg", brief_number(at.a * kDegPerRad));
      o.field("way_mm", i == 0 ? 0.0 : brief_number(way_between(job_, cut.places[i - 1], at)));
    });
  }

  const TorchJob& job_;
  const Caption& caption_;
  TorchReach reach_;
};

/// Lines for people, as the head of other programs has them.
std::vector<std::string> notes(const TorchJob& job, const Caption& caption) {
  auto out = verdict_lines(caption.verdict, {.plain = true});
  out.emplace_back(caption.options.torch ? "THIS PROGRAM LIGHTS THE TORCH"
                                         : "dry run: the torch stays off, torch=on lights it");
  for (const auto* lines : {&job.lengths, &job.process, &job.by_hand})
    out.insert(out.end(), lines->begin(), lines->end());
  return out;
}

void write_frame(Writer& w, const TorchJob& job) {
  w.object("tube", [&](Writer& o) {
    o.field("outer_diameter_mm", brief_number(2.0 * job.outer_radius));
    o.field("wall_mm", brief_number(job.wall));
  });
  w.object("frame", [&](Writer& o) {
    o.field("zero", job.zero);
    o.field("z", job.onward);
    o.field("phi", job.line + " at +x, growing towards +y: clockwise, seen from " + job.seen_from);
    o.field("b_sign", kBSignInPart);
  });
}

/// Writes the table's values, the request's, or null if the control has them.
void write_process(Writer& w, const FormatOptions& o) {
  const auto nullable = [&](std::string_view name, const std::optional<double>& value) {
    w.field(name, value ? Json{brief_number(*value)} : Json{});
  };
  w.field("lights_torch", o.torch);
  nullable("feed_mm_min", o.speed);
  nullable("pierce_height_mm", o.pierce_height);
  nullable("pierce_delay_s", o.pierce_delay);
  nullable("cut_height_mm", o.cut_height);
}

}  // namespace

std::string print_point_pairs(const TorchJob& job, const std::vector<TorchCutPlaces>& cuts,
                              const Straightness& moves, const Caption& caption) {
  const Pairs pairs(job, caption);
  Writer out(1 << 16);
  out.object([&](Writer& w) {
    w.field("post", post_of(caption.options).name);
    write_provenance(caption, w);
    w.column("notes", notes(job, caption));
    write_frame(w, job);
    write_process(w, caption.options);
    w.field("sag_mm", std::ceil(moves.sag * 1e3) / 1e3);
    w.array("cuts", cuts,
            [&](Writer& each, const TorchCutPlaces& cut) { pairs.write_cut(each, cut); });
  });
  return out.take() + "\n";
}

}  // namespace tubecut::api
