#pragma once

#include <stop_token>
#include <string>

#include "api/run.hpp"
#include "api/writer.hpp"

namespace tubecut::api {

/// A request of endpoint `E` read, computed, proved and judged; not encoded yet: see pipeline.hpp.
template <class E>
struct Worked {
  typename E::Spec spec;
  typename E::Out out;
  Answer answer;

  void encode(Writer& writer) const {
    writer.object([&](Writer& w) { E::encode(spec, out, w); });
  }
  [[nodiscard]] std::string hashed(const std::stop_token& stop) const {
    auto writer = Writer::hashing(stop);
    encode(writer);
    return writer.sha256();
  }
};

}  // namespace tubecut::api
