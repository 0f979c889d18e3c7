#include "api/formats/drawing/partner_names.hpp"

#include "api/wire/format.hpp"
#include "api/wire/json.hpp"

namespace tubecut::api {

std::vector<std::string> partner_names(const Json* cut, const std::vector<std::string>& ids,
                                       std::size_t count) {
  const auto* cutters = cut != nullptr ? cut->find("cutters") : nullptr;
  const auto* all = cutters != nullptr ? cutters->as<Json::Array>() : nullptr;
  std::vector<std::string> out;
  for (std::size_t i = 0; i < count; ++i) {
    const auto* id = all != nullptr && i < all->size() ? (*all)[i].find("id") : nullptr;
    const auto* text = id != nullptr ? id->as<std::string>() : nullptr;
    if (i < ids.size())
      out.push_back(ids[i]);
    else
      out.push_back(text != nullptr && !text->empty() ? *text : "partner " + std::to_string(i + 1));
  }
  return out;
}

std::string change_of_partner(const Caption& caption, std::size_t from, std::size_t to) {
  const auto name = [&](std::size_t i) {
    return i < caption.partners.size() ? caption.partners[i] : std::to_string(i + 1);
  };
  return name(from) + " > " + name(to);
}

}  // namespace tubecut::api
