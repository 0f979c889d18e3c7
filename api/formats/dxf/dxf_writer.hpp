#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "core/cutout/chain.hpp"

namespace tubecut::api {

/// Entities of a DXF R2000 drawing in millimetres; lines, polylines, circles and text only.
class DxfWriter {
 public:
  struct Layer {
    std::string_view name;
    int color;  // AutoCAD colour index
  };
  /// `remarks` go to the file's head.
  DxfWriter(std::vector<Layer> layers, std::vector<std::string> remarks)
      : layers_(std::move(layers)), remarks_(std::move(remarks)) {}

  /// Points (x, y); omits those equal to their predecessor.
  void polyline(const Layer& layer, const std::vector<Eigen::Vector2d>& points, bool closed);
  void polyline(const Layer& layer, const std::vector<Eigen::Vector3d>& points, bool closed);
  /// A closed chain: a circle, or a polyline whose arcs are bulges.
  void chain(const Layer& layer, const cutout::Chain& chain);
  void text(const Layer& layer, const Eigen::Vector2d& at, double height, std::string_view what);

  [[nodiscard]] std::string print() const;

 private:
  void group(int code, std::string_view value);
  void group(int code, double value);
  void group(int code, int value);
  void entity(std::string_view type, const Layer& layer, std::string_view subclass);
  void see(const Eigen::Vector3d& p);

  std::vector<Layer> layers_;
  std::vector<std::string> remarks_;
  std::vector<std::string> entities_ = {""};  // in parts: grown as one it would be moved as one
  int handle_ = 0x100;                        // those below belong to the tables
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d high_ = Eigen::Vector3d::Zero();
  bool any_ = false;
};

}  // namespace tubecut::api
