#include "api/endpoints/frames/frame_bundle.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "api/api.hpp"
#include "api/endpoints/frames/frame_formats.hpp"
#include "api/endpoints/frames/plate_answer.hpp"
#include "api/formats/gcode/gcode.hpp"
#include "api/formats/provenance.hpp"
#include "api/formats/zip_archive.hpp"
#include "api/pipeline.hpp"
#include "api/wire/file_name.hpp"
#include "api/wire/format_choice.hpp"
#include "api/wire/sha256.hpp"
#include "api/wire/writer.hpp"

namespace tubecut::api {
namespace {

/// A file of the archive.
struct Bundled {
  std::string name, format, media, sha256;
  std::size_t bytes = 0;
};
/// A requested file that was not made.
struct LeftOut {
  std::string_view file;
  Problem why;
};
struct Folder {
  std::vector<Bundled> files;
  std::vector<LeftOut> left_out;
};

class Bundle {
 public:
  Bundled add(std::string name, std::string_view format, std::string_view media,
              std::string_view content) {
    zip_.add(name, content);
    return {std::move(name), std::string(format), std::string(media), sha256(content),
            content.size()};
  }
  /// Returns the name, with a number appended if another file has it, ignoring case.
  std::string own(const std::string& name) {
    for (int i = 1;; ++i) {
      auto one = i == 1 ? name : name + "-" + std::to_string(i);
      auto folded = one;
      for (auto& c : folded)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
      if (taken_.insert(std::move(folded)).second) return one;
    }
  }
  std::string take() { return zip_.take(); }

 private:
  ZipArchive zip_;
  std::set<std::string> taken_;
};

/// Returns a name that every file system accepts; the hash at its end makes it differ from device
/// names.
std::string file_name(std::string_view text, std::string_view sha256) {
  constexpr std::size_t kLongest = 120;  // bytes; with hash, number and ending less than 255
  std::string out;
  while (!text.empty()) {
    auto rest = text;
    (void)take_character(rest);
    const auto one = text.substr(0, text.size() - rest.size());
    if (out.size() + one.size() > kLongest) break;
    out += std::string_view(" /\\:*?\"<>|%~").find(one) == std::string_view::npos ? one : "_";
    text = rest;
  }
  if (out.starts_with('.') || out.starts_with('-')) out.front() = '_';
  return out + "_" + std::string(sha256.substr(0, 8));
}

using References = std::vector<std::pair<std::string, std::string>>;

References::iterator entry(References& all, std::string_view name) {
  return std::ranges::find(all, name, &References::value_type::first);
}

/// Returns the quantity of a part: one per member, times the number of frames of the job.
std::uint64_t quantity_of(std::size_t members, const Caption& caption) {
  auto all = caption.reference;
  const auto frames = entry(all, "quantity");
  return members * (frames == all.end() ? 1 : std::stoull(frames->second));
}
std::uint64_t quantity_of(const FrameJob& frame, std::size_t i, const Caption& caption) {
  return quantity_of(frame.parts[i].members.size(), caption);
}

/// The job's reference, its part with the member's id behind it, its quantity that of the part.
References reference_of(const std::string& id, std::uint64_t count, const Caption& caption) {
  auto out = caption.reference;
  if (const auto part = entry(out, "part"); part != out.end())
    part->second += " " + id;
  else
    out.emplace(out.begin(), "part", id);
  const auto pieces = std::to_string(count);
  if (const auto quantity = entry(out, "quantity"); quantity != out.end())
    quantity->second = pieces;
  else
    out.emplace_back("quantity", pieces);
  return out;
}

const FormatName& format_of(const BundleFile& file) {
  return *std::ranges::find(format_names<Parts>(), file.format, &FormatName::name);
}

/// Of the codes acknowledged those of this verdict.
std::vector<std::string> acknowledged_of(const Verdict& verdict,
                                         const std::vector<std::string>& all) {
  std::vector<std::string> out;
  for (const auto& code : all)
    if (std::ranges::count(verdict.codes, code) > 0) out.push_back(code);
  return out;
}

/// Returns the verdict of the frame's own warnings, which no part has: of ends that are free, of
/// members that overlap.
Verdict own_verdict(const FrameJob& frame, const Caption& caption) {
  return judge(frame.frame.warnings, *caption.request, {}, {});
}

/// Returns the part's verdict, to which the frame's own is added: a lit program cuts for both.
Verdict to_cut(Verdict part, const Verdict& frame) {
  if (part.status == "ok") part.status = frame.status;
  part.reasons.insert(part.reasons.end(), frame.reasons.begin(), frame.reasons.end());
  part.warnings.insert(part.warnings.end(), frame.warnings.begin(), frame.warnings.end());
  for (const auto& code : frame.codes)
    if (std::ranges::count(part.codes, code) == 0) part.codes.push_back(code);
  return part;
}

/// Tabs of holes are of the parts that have any.
bool has_tabs(const Worked<Parts>& part, const torch::Tabs& tabs) {
  return tabs.of != torch::Tabs::Of::holes || !part.out.holes.empty();
}

void refuse_unmet(const Verdict& own, const MadeParts& made, const Caption& caption) {
  if (const auto& tabs = caption.options.tabs;
      tabs && std::ranges::none_of(made, [&](const MadePart& part) {
        return part.made && has_tabs(*part.made, *tabs);
      }))
    throw UnfitOption{"tabs_of", "no part has a hole"};
  for (const auto& code : caption.options.acknowledged)
    if (std::ranges::count(own.codes, code) == 0 &&
        std::ranges::none_of(made, [&](const MadePart& part) {
          return part.made && std::ranges::count(part.made->answer.verdict.codes, code) > 0;
        }))
      throw UnfitOption{"acknowledge", "neither the frame nor a part warns of " + code};
}

Folder write_folder(const FrameJob& frame, std::size_t i, const Worked<Parts>& part,
                    const Caption& of_frame, const Verdict& own, Bundle& bundle) {
  Folder out;
  auto caption = of_frame;
  caption.options = {};
  caption.reference =
      reference_of(name_of_part(frame, i), quantity_of(frame, i, of_frame), of_frame);
  caption.members = members_of_part(frame, i);
  auto program = caption;  // the query's other options apply only to those
  program.options = of_frame.options;
  auto to_program = part.answer;
  if (program.options.torch) to_program.verdict = to_cut(std::move(to_program.verdict), own);
  program.options.acknowledged = acknowledged_of(to_program.verdict, of_frame.options.acknowledged);
  if (const auto& tabs = of_frame.options.tabs; tabs && !has_tabs(part, *tabs))
    program.options.tabs.reset();
  const auto stem =
      bundle.own(file_name(caption.reference.front().second, part.answer.result_sha256));
  const auto request = dump(part.answer.request);
  out.files.push_back(
      bundle.add(stem + "/" + stem + ".request.json", "request", kJsonMedia, request));
  for (const auto& file : of_frame.options.files) {
    ask();
    const auto& format = format_of(file);
    auto text =
        print_document<Parts>(part.spec, part.out, format, file.needs_speed ? program : caption,
                              file.needs_speed ? to_program : part.answer);
    if (text) {
      const auto as = file.needs_speed
                          ? program_file(format, program.options, Parts::kId, {}, "")
                          : ProgramFile{std::string(format.media), std::string(file.ending), ""};
      out.files.push_back(bundle.add(stem + "/" + stem + as.ending, file.name, as.media, *text));
    } else
      out.left_out.push_back({file.name, std::move(text).error()});
  }
  return out;
}

/// A folder of one kind of plate: its numbers, and those of the requested files that plates have.
Folder write_plate_folder(const FrameJob& frame, const PlatePart& part, const Caption& of_frame,
                          const Verdict& own, Bundle& bundle) {
  Folder out;
  auto caption = of_frame;
  caption.options = {};
  caption.verdict = own;
  caption.reference =
      reference_of(name_of_plate(frame, part), quantity_of(part.plates.size(), of_frame), of_frame);
  const auto stem = bundle.own(file_name(caption.reference.front().second, part.sha256));
  out.files.push_back(bundle.add(stem + "/" + stem + ".plate.json", "plate", kJsonMedia,
                                 dump(Json{part.geometry})));
  for (const auto& file : of_frame.options.files) {
    const auto* of_plate = find_plate_file(file.name);
    if (of_plate == nullptr) {
      out.left_out.push_back(
          {file.name,
           {.code = ErrorCode::not_acceptable, .detail = "A plate has only dxf, nc1 and step."}});
      continue;
    }
    try {
      const auto text = of_plate->print(drawing_of(frame, part), caption);
      out.files.push_back(bundle.add(stem + "/" + stem + std::string(file.ending), file.name,
                                     format_of(file).media, text));
    } catch (const Unspellable& met) {
      out.left_out.push_back({file.name, unspellable_problem(met, format_of(file),
                                                             caption.reference, *caption.request)});
    }
  }
  return out;
}

void write_file(Writer& w, const Bundled& file) {
  w.object([&](Writer& o) {
    o.field("name", file.name);
    o.field("format", file.format);
    o.field("media", file.media);
    o.field("bytes", file.bytes);
    o.field("sha256", file.sha256);
  });
}

void write_problem(const Problem& why, Writer& o) {
  o.field("code", info(why.code).code);
  if (!why.detail.empty()) o.field("detail", why.detail);
  write_issues(o, why.issues);
}

void write_files(const Folder& folder, Writer& o) {
  o.array("files", folder.files, write_file);
  o.array("left_out", folder.left_out, [](Writer& each, const LeftOut& one) {
    each.object([&](Writer& l) {
      l.field("format", one.file);
      write_problem(one.why, l);
    });
  });
}

void write_folder_row(const FrameJob& frame, std::size_t i, const MadePart& part,
                      const Folder& folder, const Caption& caption, Writer& o) {
  o.field("part", name_of_part(frame, i));
  o.field("quantity", quantity_of(frame, i, caption));
  o.column("members", members_of_part(frame, i));
  if (part.problem) return o.object("problem", [&](Writer& p) { write_problem(*part.problem, p); });
  const auto& answer = part.made->answer;
  o.field("verdict", answer.verdict.status);
  o.column("reasons", answer.verdict.reasons);
  o.field("input_sha256", answer.input_sha256);
  o.field("result_sha256", answer.result_sha256);
  write_files(folder, o);
}

std::string manifest(const FrameJob& frame, const MadeParts& made,
                     const std::vector<Folder>& folders, const std::vector<Folder>& of_plates,
                     const std::vector<Bundled>& files, const Caption& caption) {
  Writer out(1 << 12);
  out.object([&](Writer& w) {
    write_provenance(caption, w);
    w.array("files", files, write_file);
    std::vector<std::size_t> parts(made.size());
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = i;
    w.array("parts", parts, [&](Writer& each, std::size_t i) {
      each.object([&](Writer& o) { write_folder_row(frame, i, made[i], folders[i], caption, o); });
    });
    std::vector<std::size_t> plates(of_plates.size());
    for (std::size_t i = 0; i < plates.size(); ++i) plates[i] = i;
    if (!plates.empty())
      w.array("plates", plates, [&](Writer& each, std::size_t i) {
        const auto& part = frame.plate_parts[i];
        each.object([&](Writer& o) {
          o.field("plate", name_of_plate(frame, part));
          o.field("quantity", quantity_of(part.plates.size(), caption));
          o.column("ids", ids_of_plates(frame, part));
          o.field("sha256", part.sha256);
          write_files(of_plates[i], o);
        });
      });
    write_not_cut(frame, w);
  });
  return out.take() + "\n";
}

}  // namespace

std::string frame_bundle(const FrameJob& frame, const MadeParts& made, const Caption& caption) {
  const auto own = own_verdict(frame, caption);
  refuse_unmet(own, made, caption);
  Bundle bundle;
  std::vector<Folder> folders(made.size());
  for (std::size_t i = 0; i < made.size(); ++i)
    if (const auto& part = made[i].made)
      folders[i] = write_folder(frame, i, *part, caption, own, bundle);
  std::vector<Folder> of_plates;
  for (const auto& part : frame.plate_parts)
    of_plates.push_back(write_plate_folder(frame, part, caption, own, bundle));
  const std::vector files{
      bundle.add("cut-list.csv", "cut-list", "text/csv", cut_list_csv(frame, made, caption)),
      bundle.add("request.json", "request", kJsonMedia, dump(*caption.request))};
  bundle.add("manifest.json", "manifest", kJsonMedia,
             manifest(frame, made, folders, of_plates, files, caption));
  return bundle.take();
}

const std::vector<std::string_view>& bundle_options() {
  static const auto kOptions = [] {
    std::vector<std::string_view> all{kFilesOption};
    all.insert(all.end(), gcode_options().begin(), gcode_options().end());
    return all;
  }();
  return kOptions;
}

}  // namespace tubecut::api
