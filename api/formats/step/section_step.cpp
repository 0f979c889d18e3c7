#include "api/formats/section_part_formats.hpp"
#include "api/formats/step/section_solid.hpp"
#include "api/formats/step/step_solid.hpp"
#include "api/formats/text.hpp"

namespace tubecut::api {

Product product_of(const section::Section& section, const std::string& member,
                   const Caption& caption) {
  return product_of(
      fixed(section.height, 3) + " x " + fixed(section.width, 3) + " x " + fixed(section.wall, 3),
      member, caption);
}

std::string section_part_step(const part::SectionPartSpec& spec, const part::SectionPart& part,
                              const Caption& caption) {
  return print_step(section_solid(spec, part), product_of(spec.section, spec.name, caption),
                    caption);
}

}  // namespace tubecut::api
