#pragma once

#include "api/api.hpp"
#include "api/wire/format.hpp"
#include "api/wire/writer.hpp"

namespace tubecut::api {

/// Writes the members of a JSON file made from an answer: engine, input, order, and verdict.
inline void write_provenance(const Caption& caption, Writer& w) {
  w.object("engine", [](Writer& o) {
    o.field("version", version());
    o.field("numerics", numerics());
  });
  w.field("input_sha256", caption.input_sha256);
  w.field("result_sha256", caption.result_sha256);
  w.object("reference", [&](Writer& o) {
    for (const auto& [name, text] : caption.reference) o.field(name, text);
  });
  w.object("verdict", [&](Writer& o) {
    o.field("status", caption.verdict.status);
    o.column("reasons", caption.verdict.reasons);
  });
}

}  // namespace tubecut::api
