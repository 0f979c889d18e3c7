#include "api/formats/mesh/gltf.hpp"

#include <algorithm>

#include "api/formats/mesh/binary.hpp"
#include "api/stop.hpp"
#include "api/wire/writer.hpp"

namespace tubecut::api {
namespace {

constexpr float kMetresPerMm = 1e-3F;
constexpr int kFloat = 5126, kUnsigned = 5125;  // component types of glTF
constexpr int kVertexTarget = 34962, kIndexTarget = 34963;

Eigen::Vector3f metres(const Eigen::Vector3d& p) { return kMetresPerMm * p.cast<float>(); }

struct BufferView {
  std::size_t from = 0, length = 0;
  int target = 0;
};

/// Returns the positions of each mesh's coordinates, colours and indices in the binary part.
std::vector<BufferView> views(const std::vector<Mesh>& meshes) {
  std::vector<BufferView> out;
  std::size_t from = 0;
  const auto add = [&](std::size_t length, int target) {
    out.push_back({from, length, target});
    from += length;
  };
  for (const auto& mesh : meshes) {
    add(3 * sizeof(float) * mesh.positions.size(), kVertexTarget);
    add(3 * sizeof(float) * mesh.colors.size(), kVertexTarget);
    add(sizeof(std::uint32_t) * mesh.indices.size(), kIndexTarget);
  }
  return out;
}

std::size_t length_of(const std::vector<BufferView>& binary) {
  return binary.empty() ? 0 : binary.back().from + binary.back().length;
}

void append_binary(std::string& out, const Mesh& mesh, Pace& pace) {
  const auto vectors = [&](const auto& all, const auto& of) {
    for (const auto& each : all) {
      pace.tick();
      const Eigen::Vector3f v = of(each);
      for (int i = 0; i < 3; ++i) append_bytes(out, v[i]);
    }
  };
  vectors(mesh.positions, metres);
  vectors(mesh.colors, [](const Eigen::Vector3f& color) { return color; });
  for (const auto index : mesh.indices) {
    pace.tick();
    append_bytes(out, index);
  }
}

void vector3(std::string_view name, const Eigen::Vector3f& v, Writer& w) {
  w.column(name, std::vector<double>{static_cast<double>(v[0]), static_cast<double>(v[1]),
                                     static_cast<double>(v[2])});
}

void accessors(const std::vector<Mesh>& meshes, Writer& w, Pace& pace) {
  struct Accessor {
    const Mesh* mesh;
    int part;  // positions, colours, indices
    std::size_t view;
  };
  std::vector<Accessor> all;
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (int part = 0; part < 3; ++part)
      all.push_back({&meshes[m], part, 3 * m + static_cast<std::size_t>(part)});
  w.array("accessors", all, [&](Writer& each, const Accessor& a) {
    each.object([&](Writer& o) {
      o.field("bufferView", a.view);
      o.field("componentType", a.part == 2 ? kUnsigned : kFloat);
      o.field("count", a.part == 2 ? a.mesh->indices.size() : a.mesh->positions.size());
      o.field("type", a.part == 2 ? "SCALAR" : "VEC3");
      if (a.part != 0) return;
      Eigen::Vector3f low = metres(a.mesh->positions.front()), high = low;
      for (const auto& p : a.mesh->positions) {
        pace.tick();
        low = low.cwiseMin(metres(p));
        high = high.cwiseMax(metres(p));
      }
      vector3("min", low, o);
      vector3("max", high, o);
    });
  });
}

/// Returns the numbers of the meshes that are `before`, or of all others.
std::string nodes_of(const std::vector<Mesh>& meshes, bool before) {
  std::string list;
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if ((meshes[i].name == "before") == before)
      list += (list.empty() ? "" : ",") + std::to_string(i);
  return list;
}

/// Returns the scenes. The shape before has its own, because viewers show one scene and it would
/// cover the other.
std::string scenes(const std::vector<Mesh>& meshes) {
  const auto before = nodes_of(meshes, true), after = nodes_of(meshes, false);
  if (before.empty()) return "[{\"nodes\":[" + after + "]}]";
  return "[{\"name\":\"after\",\"nodes\":[" + after + "]},{\"name\":\"before\",\"nodes\":[" +
         before + "]}]";
}

std::string document(const std::vector<Mesh>& meshes, const std::vector<BufferView>& binary,
                     const Caption& caption, Pace& pace) {
  std::vector<std::size_t> numbers(meshes.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
  Writer out;
  out.object([&](Writer& w) {
    w.object("asset", [&](Writer& o) {
      o.field("version", "2.0");
      o.field("generator", job_line(caption));
      o.object("extras", [&](Writer& e) {
        e.field("verdict", caption.verdict.status);
        e.column("reasons", caption.verdict.reasons);
        e.column("warnings", caption.verdict.warnings);
      });
    });
    w.field("scene", 0);
    w.raw("scenes", scenes(meshes));
    w.array("nodes", numbers, [&](Writer& each, std::size_t i) {
      each.object([&](Writer& o) {
        o.field("name", meshes[i].name);
        o.field("mesh", i);
      });
    });
    w.array("materials", meshes, [](Writer& each, const Mesh& mesh) {
      each.object([&](Writer& o) {
        o.field("doubleSided", true);
        o.field("alphaMode", mesh.opacity < 1.0F ? "BLEND" : "OPAQUE");
        o.object("pbrMetallicRoughness", [&](Writer& p) {
          p.column("baseColorFactor",
                   std::vector<double>{1.0, 1.0, 1.0, static_cast<double>(mesh.opacity)});
          p.field("metallicFactor", 0.1);
          p.field("roughnessFactor", 0.7);
        });
      });
    });
    w.array("meshes", numbers, [&](Writer& each, std::size_t i) {
      each.object([&](Writer& o) {
        o.field("name", meshes[i].name);
        o.raw("primitives", "[{\"attributes\":{\"POSITION\":" + std::to_string(3 * i) +
                                ",\"COLOR_0\":" + std::to_string(3 * i + 1) +
                                "},\"indices\":" + std::to_string(3 * i + 2) +
                                ",\"material\":" + std::to_string(i) + "}]");
      });
    });
    accessors(meshes, w, pace);
    w.array("bufferViews", binary, [](Writer& each, const BufferView& view) {
      each.object([&](Writer& o) {
        o.field("buffer", 0);
        o.field("byteOffset", view.from);
        o.field("byteLength", view.length);
        o.field("target", view.target);
      });
    });
    w.raw("buffers", "[{\"byteLength\":" + std::to_string(length_of(binary)) + "}]");
  });
  return out.take();
}

void chunk_head(std::string& out, std::size_t length, std::uint32_t kind) {
  append_bytes(out, static_cast<std::uint32_t>(length));
  append_bytes(out, kind);
}

}  // namespace

std::string print_gltf(const std::vector<Mesh>& meshes, const Caption& caption) {
  constexpr std::size_t kHead = 12, kChunkHead = 8;
  Pace pace;
  const auto binary = views(meshes);
  auto json = document(meshes, binary, caption, pace);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto total = kHead + kChunkHead + json.size() + kChunkHead + length_of(binary);
  std::string out = "glTF";
  out.reserve(total);
  append_bytes(out, std::uint32_t{2});
  append_bytes(out, static_cast<std::uint32_t>(total));
  chunk_head(out, json.size(), 0x4E4F534A);
  out += json;
  chunk_head(out, length_of(binary), 0x004E4942);  // a multiple of 4 as it is
  for (const auto& mesh : meshes) append_binary(out, mesh, pace);
  return out;
}

Eigen::Vector3f diverging(double value) {
  const Eigen::Vector3f grey(0.72F, 0.74F, 0.76F), red(0.75F, 0.10F, 0.08F),
      blue(0.05F, 0.20F, 0.70F);
  const auto t = static_cast<float>(std::clamp(value, -1.0, 1.0));
  return t < 0.0F ? Eigen::Vector3f((1.0F + t) * grey - t * blue)
                  : Eigen::Vector3f((1.0F - t) * grey + t * red);
}

std::vector<std::uint32_t> band_triangles(std::size_t rings, std::size_t across) {
  std::vector<std::uint32_t> out;
  out.reserve(6 * rings * (across - 1));
  Pace pace;
  for (std::size_t i = 0; i < rings; ++i)
    for (std::size_t k = 0; k + 1 < across; ++k) {
      pace.tick();
      const auto a = static_cast<std::uint32_t>(i * across + k);
      const auto b = static_cast<std::uint32_t>((i + 1) % rings * across + k);
      for (const auto v : {a, b, a + 1, b, b + 1, a + 1}) out.push_back(v);
    }
  return out;
}

}  // namespace tubecut::api
