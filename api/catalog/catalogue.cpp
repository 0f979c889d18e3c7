#include "api/catalog/catalogue.hpp"

#include <algorithm>
#include <array>

#include "api/api.hpp"
#include "api/batch.hpp"
#include "api/catalog/machines.hpp"
#include "api/catalog/posts.hpp"
#include "api/catalog/section_sizes.hpp"
#include "api/catalog/tube_sizes.hpp"
#include "api/endpoint.hpp"
#include "api/limits.hpp"
#include "api/wire/problem.hpp"
#include "api/wire/warning_names.hpp"

namespace tubecut::api {
namespace {

constexpr std::string_view kJson = "application/json";

std::string print_errors(const Context& context) {
  Writer out;
  out.object([&](Writer& w) {
    w.array("errors", all_errors(), [&](Writer& each, const ErrorInfo& error) {
      each.object([&](Writer& o) {
        o.field("code", error.code);
        o.field("status", context.status(error.kind));
        o.field("retryable", retryable(error.kind));
        o.field("meaning", error.meaning);
        o.field("action", error.action);
      });
    });
    w.array("warnings", all_warnings(), [](Writer& each, const WarningInfo& warning) {
      each.object([&](Writer& o) {
        o.field("code", warning.code);
        o.field("severity", name_of(warning.severity));
        o.field("meaning", warning.meaning);
        o.field("action", warning.action);
      });
    });
  });
  return out.take();
}

std::string errors_page(const Context& context) {
  static const std::string page =
      print_errors(context);  // the same for ever: 20 kB of text to escape
  return page;
}

/// A limit as this replica holds to it: its bodies may be smaller than the contract's.
double in_force(std::string_view name, double limit, std::size_t max_body) {
  return name.ends_with("_bytes") ? std::min(limit, static_cast<double>(max_body)) : limit;
}

std::string limits_page(const Context& context) {
  Writer out;
  out.object([&](Writer& w) {
    w.object("limits", [&](Writer& o) {
#define X(name, value) o.field(#name, in_force(#name, limit::name, context.max_body));
      TUBECUT_LIMITS(X)
#undef X
    });
    w.object("budgets", [&](Writer& o) {
      for (const auto& endpoint : endpoints())
        o.object(endpoint.id, [&](Writer& each) {
          const double cpu = budget_s(endpoint.path, context);
          each.field("cpu_s", cpu);
          each.field("wall_s", kWallPerCpu * cpu);
        });
    });
    w.object("verification", [](Writer& o) {
      for (const auto& endpoint : endpoints())
        o.array(endpoint.id, endpoint.checks, [](Writer& each, const CheckLimit& check) {
          each.object([&](Writer& c) {
            c.field("name", check.name);
            c.field("limit", check.limit);
            c.field("unit", check.unit);
          });
        });
    });
  });
  return out.take();
}

std::string version_page(const Context& /*context*/) {
  Writer out;
  out.object([](Writer& w) {
    w.field("engine", engine());
    w.field("version", version());
    w.field("commit", commit());
    w.field("numerics", numerics());
    w.field("configuration_sha256", configuration_sha256());
    encode_machine_hashes(w);
    encode_post_hashes(w);
    w.array("endpoints", endpoints(), [](Writer& each, const Endpoint& endpoint) {
      each.object([&](Writer& o) {
        o.field("id", endpoint.id);
        o.field("path", endpoint.path);
        std::vector<std::string> formats{"application/json", "application/cbor"};
        for (const auto& format : endpoint.formats) formats.emplace_back(format.media);
        o.column("formats", formats);
      });
    });
    w.object("batches", [](Writer& o) {
      o.field("path", kBatchesPath);
      o.column("formats", std::vector<std::string>{"application/x-ndjson"});
    });
  });
  return out.take();
}

std::string tubes_page(const Context& /*context*/) {
  Writer out;
  out.object([](Writer& w) {
    w.array("tubes", tube_sizes(), [](Writer& each, const TubeSize& tube) {
      each.object([&](Writer& o) {
        o.field("size", tube.name);
        o.field("outer_diameter_mm", tube.outer_diameter);
        o.field("wall_mm", tube.wall);
        o.field("standard", tube.standard);
      });
    });
    w.array("rectangular_tubes", section_sizes(), [](Writer& each, const SectionSize& tube) {
      each.object([&](Writer& o) {
        const auto& s = tube.section;
        o.field("size", tube.name);
        o.field("height_mm", s.height);
        o.field("width_mm", s.width);
        o.field("wall_mm", s.wall);
        o.field("corner_radius_mm", s.corner);
        o.field("inner_corner_radius_mm", s.inner_corner);
        o.field("girth_mm", s.outer().girth());
        o.field("area_mm2", section::area(s));
        o.field("mass_kg_per_m", section::mass_per_metre(s));
        o.field("standard", tube.standard);
      });
    });
  });
  return out.take();
}

std::string examples_page(const Context& /*context*/) {
  Writer out;
  out.object([](Writer& w) {
    w.array("examples", examples(), [](Writer& each, const Example& example) {
      each.object([&](Writer& o) {
        o.field("endpoint", example.endpoint);
        o.field("name", example.name);
        o.raw("body", example.body);
      });
    });
  });
  return out.take();
}

}  // namespace

std::string embedded(std::string_view name) {
  return std::string(std::ranges::find(embedded_files(), name, &Embedded::name)->text);
}

/// examples/[<theme>/]<endpoint>/<name>.json: requests that run.
std::vector<Example> examples() {
  std::vector<Example> out;
  for (const auto& file : embedded_files()) {
    if (!file.name.starts_with("examples/") || !file.name.ends_with(".json")) continue;
    const auto inner = file.name.substr(9, file.name.size() - 14);
    const auto slash = inner.rfind('/');
    const auto theme = inner.rfind('/', slash - 1);
    const auto endpoint = theme == std::string_view::npos ? 0 : theme + 1;
    out.push_back({inner.substr(endpoint, slash - endpoint),
                   std::string(inner.substr(0, endpoint)) + std::string(inner.substr(slash + 1)),
                   file.text});
  }
  return out;
}

const Page* find_page(std::string_view path) {
  static constexpr auto kPages = std::to_array<Page>(
      {{"/v1/errors", kJson, errors_page},
       {"/v1/limits", kJson, limits_page},
       {"/v1/version", kJson, version_page},
       {"/v1/machines", kJson, [](const Context&) { return machines_page(); }},
       {"/v1/posts", kJson, [](const Context&) { return posts_page(); }},
       {"/v1/tubes", kJson, tubes_page},
       {"/v1/examples", kJson, examples_page},
       {"/openapi.yaml", "application/yaml",
        [](const Context&) { return embedded("openapi.yaml"); }},
       {"/openapi.json", kJson, [](const Context&) { return embedded("openapi.json"); }}});
  const auto found = std::ranges::find(kPages, path, &Page::path);
  return found == kPages.end() ? nullptr : &*found;
}

}  // namespace tubecut::api
