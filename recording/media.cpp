#include "recording/media.hpp"

#include <algorithm>
#include <array>

namespace racebeam {
namespace {

struct Form {
  MediaKind kind;
  std::string_view name;  // the kind in a request; empty: recordings do not have this kind
  std::string_view ending;
  decltype(&make_png) make;
};

constexpr std::array kForms = {
    Form{MediaKind::kPng, "png", "", make_png},         Form{MediaKind::kGif, "gif", ".gif", make_gif},
    Form{MediaKind::kY4m, "y4m", ".y4m", make_y4m},     Form{MediaKind::kWav, "wav", ".wav", make_wav},
    Form{MediaKind::kWebm, "webm", ".webm", make_webm}, Form{MediaKind::kMp4, "mp4", ".mp4", make_mp4},
    Form{MediaKind::kPicture, "", ".png", make_picture}};

const Form& form(MediaKind kind) { return *std::ranges::find(kForms, kind, &Form::kind); }

}  // namespace

std::optional<MediaKind> media_kind(std::string_view name) {
  const auto found = std::ranges::find(kForms, name, &Form::name);
  if (name.empty() || found == kForms.end()) return std::nullopt;
  return found->kind;
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
