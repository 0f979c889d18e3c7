#include "api/formats/gltf.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "api/stop.hpp"
#include "api/writer.hpp"

namespace tubecut::api {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little endian");
constexpr float kMetresPerMm = 1e-3F;
constexpr int kFloat = 5126, kUnsigned = 5125;  // component types of glTF
constexpr int kVertexTarget = 34962, kIndexTarget = 34963;

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

Eigen::Vector3f metres(const Eigen::Vector3d& p) { return kMetresPerMm * p.cast<float>(); }

struct Stretch {
  std::size_t from = 0, length = 0;
  int target = 0;
};

/// The binary part: positions, colours and indices of every mesh, each a view of its own.
struct Buffer {
  std::string bytes;
  std::vector<Stretch> views;

  void vectors(const std::vector<Eigen::Vector3f>& values) {
    const auto from = bytes.size();
    for (const auto& v : values)
      for (int i = 0; i < 3; ++i) append(bytes, v[i]);
    views.push_back({from, bytes.size() - from, kVertexTarget});
  }
  void indices(const std::vector<std::uint32_t>& values) {
    const auto from = bytes.size();
    for (const auto v : values) append(bytes, v);
    views.push_back({from, bytes.size() - from, kIndexTarget});
  }
};

void vector3(std::string_view name, const Eigen::Vector3f& v, Writer& w) {
  w.column(name, std::vector<double>{static_cast<double>(v[0]), static_cast<double>(v[1]),
                                     static_cast<double>(v[2])});
}

void accessors(const std::vector<Mesh>& meshes, Writer& w) {
  struct Accessor {
    const Mesh* mesh;
    int part;  // positions, colours, indices
    std::size_t view;
  };
  std::vector<Accessor> all;
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (int part = 0; part < 3; ++part)
      all.push_back({&meshes[m], part, 3 * m + static_cast<std::size_t>(part)});
  w.array("accessors", all, [](Writer& each, const Accessor& a) {
    each.object([&](Writer& o) {
      o.field("bufferView", a.view);
      o.field("componentType", a.part == 2 ? kUnsigned : kFloat);
      o.field("count", a.part == 2 ? a.mesh->indices.size() : a.mesh->positions.size());
      o.field("type", a.part == 2 ? "SCALAR" : "VEC3");
      if (a.part != 0) return;
      Eigen::Vector3f low = metres(a.mesh->positions.front()), high = low;
      for (const auto& p : a.mesh->positions) {
        low = low.cwiseMin(metres(p));
        high = high.cwiseMax(metres(p));
      }
      vector3("min", low, o);
      vector3("max", high, o);
    });
  });
}

/// Numbers of the meshes that are what was before, or of all others.
std::string nodes_of(const std::vector<Mesh>& meshes, bool before) {
  std::string list;
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if ((meshes[i].name == "before") == before)
      list += (list.empty() ? "" : ",") + std::to_string(i);
  return list;
}

/// A viewer shows one scene: what was before has its own, so that it does not lie over what is.
std::string scenes(const std::vector<Mesh>& meshes) {
  const auto before = nodes_of(meshes, true), after = nodes_of(meshes, false);
  if (before.empty()) return "[{\"nodes\":[" + after + "]}]";
  return "[{\"name\":\"after\",\"nodes\":[" + after + "]},{\"name\":\"before\",\"nodes\":[" +
         before + "]}]";
}

std::string document(const std::vector<Mesh>& meshes, const Buffer& buffer,
                     const Caption& caption) {
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
    accessors(meshes, w);
    w.array("bufferViews", buffer.views, [](Writer& each, const Stretch& view) {
      each.object([&](Writer& o) {
        o.field("buffer", 0);
        o.field("byteOffset", view.from);
        o.field("byteLength", view.length);
        o.field("target", view.target);
      });
    });
    w.raw("buffers", "[{\"byteLength\":" + std::to_string(buffer.bytes.size()) + "}]");
  });
  return out.take();
}

void chunk(std::string& out, std::string body, std::uint32_t kind, char padding) {
  while (body.size() % 4 != 0) body += padding;
  append(out, static_cast<std::uint32_t>(body.size()));
  append(out, kind);
  out += body;
}

}  // namespace

std::string print_gltf(const std::vector<Mesh>& meshes, const Caption& caption) {
  Buffer buffer;
  for (const auto& mesh : meshes) {
    ask(caption.stop);
    std::vector<Eigen::Vector3f> positions;
    for (const auto& p : mesh.positions) positions.push_back(metres(p));
    buffer.vectors(positions);
    buffer.vectors(mesh.colors);
    buffer.indices(mesh.indices);
  }
  std::string chunks;
  chunk(chunks, document(meshes, buffer, caption), 0x4E4F534A, ' ');
  chunk(chunks, buffer.bytes, 0x004E4942, '\0');
  std::string out = "glTF";
  append(out, std::uint32_t{2});
  append(out, static_cast<std::uint32_t>(12 + chunks.size()));
  return out + chunks;
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
  for (std::size_t i = 0; i < rings; ++i)
    for (std::size_t k = 0; k + 1 < across; ++k) {
      const auto a = static_cast<std::uint32_t>(i * across + k);
      const auto b = static_cast<std::uint32_t>((i + 1) % rings * across + k);
      for (const auto v : {a, b, a + 1, b, b + 1, a + 1}) out.push_back(v);
    }
  return out;
}

}  // namespace tubecut::api
