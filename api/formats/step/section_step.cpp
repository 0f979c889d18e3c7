#include "api/formats/section_part_formats.hpp"
#include "api/formats/step/section_solid.hpp"
#include "api/formats/step/step_solid.hpp"
#include "api/formats/text.hpp"

namespace tubecut::api {

Product product_of(const section::Section& section, const std::string& member,
                   const Caption& caption) {
  Product out{.id = member,
              .name = "tube " + fixed(section.height, 3) + " x " + fixed(section.width, 3) + " x " +
                      fixed(section.wall, 3) + " mm",
              .revision = {}};
  for (const auto& [key, text] : caption.reference) {
    if (key == "part") out.id = text;
    if (key == "revision") out.revision = text;
  }
  if (out.id.empty()) out.id = caption.input_sha256.substr(0, 16);
  return out;
}

std::string section_part_step(const part::SectionPartSpec& spec, const part::SectionPart& part,
                              const Caption& caption) {
  return print_step(section_solid(spec, part, caption.stop),
                    product_of(spec.section, spec.name, caption), caption);
}

}  // namespace tubecut::api
