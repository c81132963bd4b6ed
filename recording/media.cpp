#include "recording/media.hpp"

#include <algorithm>
#include <array>

namespace racebeam {
namespace {

struct Form {
  std::string_view name;  // as a recording's kind; empty if recordings lack it
  std::string_view ending;
  decltype(&make_png) make;
};

constexpr std::array kForms = {Form{"png", "", make_png},        Form{"gif", ".gif", make_gif},
                               Form{"y4m", ".y4m", make_y4m},    Form{"wav", ".wav", make_wav},
                               Form{"webm", ".webm", make_webm}, Form{"mp4", ".mp4", make_mp4},
                               Form{"", ".png", make_picture}};

const Form& form(MediaKind kind) { return kForms[static_cast<std::size_t>(kind)]; }

}  // namespace

std::optional<MediaKind> media_kind(std::string_view name) {
  const auto found = std::ranges::find(kForms, name, &Form::name);
  if (name.empty() || found == kForms.end()) return std::nullopt;
  return static_cast<MediaKind>(found - kForms.begin());
}

bool is_encoded(MediaKind kind) { return kind == MediaKind::kWebm || kind == MediaKind::kMp4; }

std::string file_name(MediaKind kind, const std::string& name) {
  return name + std::string(form(kind).ending);
}

std::unique_ptr<Media> make_media(MediaKind kind, const std::string& folder, const std::string& name,
                                  const Footage& footage, DiskBudget& budget) {
  return form(kind).make(folder + "/" + file_name(kind, name), footage, budget);
}

}  // namespace racebeam
