#pragma once

#include <string>
#include <vector>

#include "api/formats/drawing/development.hpp"
#include "api/formats/drawing/pdf_sheets.hpp"
#include "api/formats/drawing/sections.hpp"
#include "api/formats/drawing/svg_sheets.hpp"
#include "api/formats/drawing/wrap_template.hpp"

namespace tubecut::api {

/// A cut on sheets of true size: the view `section`, else its template.
template <class Spec, class Cut>
std::vector<Canvas> cut_sheets(const Spec& spec, const Cut& cut, const Caption& caption) {
  if (caption.view != "section") return wrap_template(developed(spec, cut), caption);
  refuse_paper(caption);
  return {section_sheet(sections_of(spec, cut), caption)};
}

template <class Spec, class Cut>
std::string cut_svg(const Spec& spec, const Cut& cut, const Caption& caption) {
  return print_svg(cut_sheets(spec, cut, caption),
                   caption.view == "section" ? "Sections" : "Wrap template 1:1");
}

template <class Spec, class Cut>
std::string cut_pdf(const Spec& spec, const Cut& cut, const Caption& caption) {
  return print_pdf(cut_sheets(spec, cut, caption),
                   caption.view == "section" ? "Sections" : "Wrap template 1:1");
}

}  // namespace tubecut::api
