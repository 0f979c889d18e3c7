#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/formats/mesh/tube_solid.hpp"
#include "api/formats/step/brep.hpp"
#include "api/formats/step/step_file.hpp"
#include "api/stop.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// The file's name of a solid.
struct Product {
  std::string id, name, revision;
};

/// Products of AP214 in mm, one file: solids, and assemblies of them. The walls of a solid are
/// grey, its cuts of a colour of their own, each face has its name. Head and products carry the
/// job, the reference, both hashes and the verdict.
class StepFile {
 public:
  using Id = StepEntities::Id;
  struct Shape {
    Id definition = 0, representation = 0, axes = 0;
  };
  /// One more of a shape, in a frame of the assembly: rows are its x, y and z there.
  struct Placed {
    Shape shape;
    std::string name;
    Eigen::Vector3d origin;
    Eigen::Matrix3d rows;
  };

  /// `thinnest`: wall of its solids, which determines the digits of their coordinates.
  StepFile(double thinnest, const Caption& caption);

  Shape solid(const TubeSolid& solid, const Product& product);
  Shape solid(const Brep& solid, const Product& product);
  void assembly(const Product& product, const std::vector<Placed>& parts);
  /// The whole text; `what` it holds, in words.
  [[nodiscard]] std::string print(const Product& product, std::string_view what) const;

 private:
  Id add_product(const Product& product);
  /// `print`: its boundary, and the faces of its cuts.
  Shape add_solid(const Product& product,
                  const std::function<std::pair<Id, std::vector<Id>>()>& print);
  Id style(const std::array<double, 3>& rgb);
  void colour(Id brep, const std::vector<Id>& cut_faces);

  const Caption& caption_;
  Pace pace_;
  StepEntities entities_;
  Id context_ = 0;
};

/// Returns the file's name for a tube of a size: the reference's part takes precedence over
/// `member`.
[[nodiscard]] Product product_of(const std::string& size, const std::string& member,
                                 const Caption& caption);

/// A file of one solid.
[[nodiscard]] std::string print_step(const TubeSolid& solid, const Product& product,
                                     const Caption& caption);
[[nodiscard]] std::string print_step(const Brep& solid, const Product& product,
                                     const Caption& caption);

}  // namespace tubecut::api
