#include "api/formats/dxf/dxf_writer.hpp"

#include <charconv>
#include <cmath>

#include "api/formats/text.hpp"
#include "api/stop.hpp"
#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

constexpr std::string_view kModelSpace = "1F", kPaperSpace = "1B";

std::string hex(int value) {
  char text[16];
  std::string out{text, std::to_chars(text, text + sizeof text, value, 16).ptr};
  for (auto& c : out)
    if (c >= 'a') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

/// Groups of a table or an object, "code value" a line; the parts of R2000 that never change.
std::string groups(std::string_view lines) {
  std::string out;
  while (!lines.empty()) {
    const auto end = lines.find('\n');
    const auto line = lines.substr(0, end);
    const auto space = line.find(' ');
    out += std::string(line.substr(0, space)) + "\r\n" +
           std::string(space == std::string_view::npos ? "" : line.substr(space + 1)) + "\r\n";
    lines = end == std::string_view::npos ? std::string_view{} : lines.substr(end + 1);
  }
  return out;
}

std::string table(std::string_view name, std::string_view handle, int count,
                  const std::string& records) {
  return groups("0 TABLE\n2 " + std::string(name) + "\n5 " + std::string(handle) +
                "\n330 0\n100 AcDbSymbolTable\n70 " + std::to_string(count)) +
         records + groups("0 ENDTAB");
}

std::string line_type(std::string_view handle, std::string_view name) {
  return groups("0 LTYPE\n5 " + std::string(handle) +
                "\n330 5\n100 AcDbSymbolTableRecord\n100 AcDbLinetypeTableRecord\n2 " +
                std::string(name) + "\n70 0\n3 \n72 65\n73 0\n40 0.0");
}

std::string layer(int handle, std::string_view name, int color) {
  return groups("0 LAYER\n5 " + hex(handle) +
                "\n330 2\n100 AcDbSymbolTableRecord\n100 AcDbLayerTableRecord\n2 " +
                std::string(name) + "\n70 0\n62 " + std::to_string(color) +
                "\n6 Continuous\n370 25\n390 F");
}

std::string block_record(std::string_view handle, std::string_view name) {
  return groups("0 BLOCK_RECORD\n5 " + std::string(handle) +
                "\n330 1\n100 AcDbSymbolTableRecord\n100 AcDbBlockTableRecord\n2 " +
                std::string(name) + "\n340 0");
}

std::string block(std::string_view owner, std::string_view begin, std::string_view end,
                  std::string_view name) {
  const std::string of(owner), id(name);
  return groups("0 BLOCK\n5 " + std::string(begin) + "\n330 " + of +
                "\n100 AcDbEntity\n8 0\n100 AcDbBlockBegin\n2 " + id +
                "\n70 0\n10 0.0\n20 0.0\n30 0.0\n3 " + id + "\n1 \n0 ENDBLK\n5 " +
                std::string(end) + "\n330 " + of + "\n100 AcDbEntity\n8 0\n100 AcDbBlockEnd");
}

std::string tables(const std::vector<DxfWriter::Layer>& layers) {
  std::string all = layer(0x10, "0", 7);
  int handle = 0x60;
  for (const auto& l : layers) all += layer(handle++, l.name, l.color);
  return groups("0 SECTION\n2 TABLES") + table("VPORT", "8", 0, "") +
         table("LTYPE", "5", 3,
               line_type("14", "ByBlock") + line_type("15", "ByLayer") +
                   line_type("16", "Continuous")) +
         table("LAYER", "2", static_cast<int>(layers.size()) + 1, all) +
         table("STYLE", "3", 1,
               groups("0 STYLE\n5 11\n330 3\n100 AcDbSymbolTableRecord\n100 "
                      "AcDbTextStyleTableRecord\n2 Standard\n70 0\n40 0.0\n41 1.0\n50 0.0\n71 "
                      "0\n42 2.5\n3 txt\n4 ")) +
         table("VIEW", "6", 0, "") + table("UCS", "7", 0, "") +
         table("APPID", "9", 1,
               groups("0 APPID\n5 12\n330 9\n100 AcDbSymbolTableRecord\n100 "
                      "AcDbRegAppTableRecord\n2 ACAD\n70 0")) +
         groups(
             "0 TABLE\n2 DIMSTYLE\n5 A\n330 0\n100 AcDbSymbolTable\n70 1\n100 "
             "AcDbDimStyleTable\n0 DIMSTYLE\n105 27\n330 A\n100 AcDbSymbolTableRecord\n100 "
             "AcDbDimStyleTableRecord\n2 Standard\n70 0\n340 11\n0 ENDTAB") +
         table("BLOCK_RECORD", "1", 2,
               block_record(kModelSpace, "*Model_Space") +
                   block_record(kPaperSpace, "*Paper_Space")) +
         groups("0 ENDSEC");
}

std::string objects() {
  return groups(
      "0 SECTION\n2 OBJECTS\n0 DICTIONARY\n5 C\n330 0\n100 AcDbDictionary\n281 1\n3 ACAD_GROUP\n"
      "350 D\n3 ACAD_PLOTSTYLENAME\n350 E\n0 DICTIONARY\n5 D\n330 C\n100 AcDbDictionary\n281 1\n"
      "0 ACDBDICTIONARYWDFLT\n5 E\n330 C\n100 AcDbDictionary\n281 1\n3 Normal\n350 F\n"
      "100 AcDbDictionaryWithDefault\n340 F\n0 ACDBPLACEHOLDER\n5 F\n330 E\n0 ENDSEC\n0 EOF");
}

}  // namespace

void DxfWriter::group(int code, std::string_view value) {
  constexpr std::size_t kPart = 256u << 10;
  if (entities_.back().size() > kPart) entities_.emplace_back();
  entities_.back() += std::to_string(code) + "\r\n" + std::string(value) + "\r\n";
}
void DxfWriter::group(int code, double value) { group(code, fixed(value, 6)); }
void DxfWriter::group(int code, int value) { group(code, std::to_string(value)); }

void DxfWriter::see(const Eigen::Vector3d& p) {
  low_ = any_ ? Eigen::Vector3d(low_.cwiseMin(p)) : p;
  high_ = any_ ? Eigen::Vector3d(high_.cwiseMax(p)) : p;
  any_ = true;
}

void DxfWriter::entity(std::string_view type, const Layer& layer, std::string_view subclass) {
  group(0, type);
  group(5, hex(handle_++));
  group(330, kModelSpace);
  group(100, "AcDbEntity");
  group(8, layer.name);
  group(100, subclass);
}

void DxfWriter::polyline(const Layer& layer, const std::vector<Eigen::Vector2d>& points,
                         bool closed) {
  std::vector<Eigen::Vector2d> kept;
  for (const auto& p : points) {
    ask();
    if (kept.empty() || (p - kept.back()).norm() > 1e-6) kept.push_back(p);
  }
  if (closed && kept.size() > 1 && (kept.front() - kept.back()).norm() <= 1e-6) kept.pop_back();
  if (kept.size() < 2) return;
  entity("LWPOLYLINE", layer, "AcDbPolyline");
  group(90, static_cast<int>(kept.size()));
  group(70, closed ? 1 : 0);
  for (const auto& p : kept) {
    ask();
    group(10, p.x());
    group(20, p.y());
    see({p.x(), p.y(), 0.0});
  }
}

void DxfWriter::polyline(const Layer& layer, const std::vector<Eigen::Vector3d>& points,
                         bool closed) {
  entity("POLYLINE", layer, "AcDb3dPolyline");
  const auto owner = hex(handle_ - 1);
  group(66, 1);
  for (const int code : {10, 20, 30}) group(code, 0.0);
  group(70, closed ? 9 : 8);
  const auto part = [&](std::string_view type) {
    group(0, type);
    group(5, hex(handle_++));
    group(330, owner);
    group(100, "AcDbEntity");
    group(8, layer.name);
  };
  for (const auto& p : points) {
    ask();
    part("VERTEX");
    group(100, "AcDbVertex");
    group(100, "AcDb3dPolylineVertex");
    group(10, p.x());
    group(20, p.y());
    group(30, p.z());
    group(70, 32);
    see(p);
  }
  part("SEQEND");
}

void DxfWriter::chain(const Layer& layer, const cutout::Chain& chain) {
  const auto box = cutout::bounds(chain);
  for (const auto& p : {box.least, box.most}) see({p.x(), p.y(), 0.0});
  if (const auto& one = chain.front(); chain.size() == 1 && std::abs(one.sweep) == kTwoPi) {
    entity("CIRCLE", layer, "AcDbCircle");
    group(10, one.centre.x());
    group(20, one.centre.y());
    group(30, 0.0);
    group(40, one.radius);
    return;
  }
  entity("LWPOLYLINE", layer, "AcDbPolyline");
  group(90, static_cast<int>(chain.size()));
  group(70, 1);
  for (const auto& s : chain) {
    ask();
    group(10, s.from.x());
    group(20, s.from.y());
    if (!s.arc()) continue;
    const auto quarter = elementary::sincos(0.25 * s.sweep);
    group(42, fixed(quarter.sin / quarter.cos, 12));
  }
}

void DxfWriter::text(const Layer& layer, const Eigen::Vector2d& at, double height,
                     std::string_view what) {
  entity("TEXT", layer, "AcDbText");
  group(10, at.x());
  group(20, at.y());
  group(30, 0.0);
  group(40, height);
  group(1, dxf_text(what));
  group(100, "AcDbText");
  see({at.x(), at.y(), 0.0});
}

std::string DxfWriter::print() const {
  const auto corner = [](std::string_view name, const Eigen::Vector3d& p) {
    return groups("9 " + std::string(name) + "\n10 " + fixed(p.x(), 6) + "\n20 " + fixed(p.y(), 6) +
                  "\n30 " + fixed(p.z(), 6));
  };
  std::string out = groups("999 tubecut drawing in millimetres");
  for (const auto& line : remarks_) out += groups("999 " + dxf_text(line));
  out += groups(
             "0 SECTION\n2 HEADER\n"
             "9 $ACADVER\n1 AC1015\n9 $DWGCODEPAGE\n3 ANSI_1252\n9 $INSUNITS\n70 4\n"
             "9 $MEASUREMENT\n70 1\n9 $HANDSEED\n5 " +
             hex(handle_)) +
         corner("$EXTMIN", low_) + corner("$EXTMAX", high_) +
         groups("0 ENDSEC\n0 SECTION\n2 CLASSES\n0 ENDSEC") + tables(layers_) +
         groups("0 SECTION\n2 BLOCKS") + block(kModelSpace, "20", "21", "*Model_Space") +
         block(kPaperSpace, "1C", "1D", "*Paper_Space") + groups("0 ENDSEC\n0 SECTION\n2 ENTITIES");
  const auto end = groups("0 ENDSEC") + objects();
  std::size_t size = out.size() + end.size();
  for (const auto& part : entities_) size += part.size();
  out.reserve(size);
  for (const auto& part : entities_) out += part;
  out += end;
  return out;
}

}  // namespace tubecut::api
