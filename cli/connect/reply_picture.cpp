#include "cli/connect/reply_picture.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <racebeam/client/field_table.hpp>
#include <racebeam/client/reply.hpp>
#include <stdexcept>
#include <utility>

namespace racebeam {
namespace {

using client::Bytes, client::Encoding, client::Group;
using Pixels = ReplyPicture::Pixels;

constexpr std::size_t kWidth = 160, kUsualHeight = 210, kMinHeight = 200, kMaxHeight = 256;
constexpr std::size_t kPalette = 768;
constexpr std::size_t kMaxRaw = std::size_t{1} << 28;
constexpr std::string_view kFinal = "final_", kPngInBase64 = "iVBORw0KGgo";

// What a field of a picture consists of. height: 0 for that of the screen.
struct Form {
  Pixels pixels;
  std::size_t channels, width, height = 0, screens = 1;

  std::size_t size(std::size_t rows) const { return channels * width * rows * screens; }
};

std::optional<std::size_t> number(std::string_view text) {
  constexpr std::size_t kDigits = 9;
  const bool digits = std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
  if (text.empty() || text.size() > kDigits || !digits) return std::nullopt;
  return client::detail::to_number<std::size_t>(text);
}

// The form of fields such as grey84x84x4 and rgb40x30x2.
std::optional<Form> resized_form(std::string_view field) {
  const bool colours = field.starts_with("rgb");
  if (!colours && !field.starts_with("grey")) return std::nullopt;
  std::vector<std::size_t> sizes;
  for (const std::string_view part : client::detail::split(field.substr(colours ? 3 : 4), 'x')) {
    const auto size = number(part);
    if (!size || *size == 0 || *size > 1000) return std::nullopt;
    sizes.push_back(*size);
  }
  if (!colours && sizes.size() < 3 && !sizes.empty() && sizes[0] == 84)
    return Form{Pixels::kGrey, 1, 84, 84, sizes.size() == 2 ? sizes[1] : 1};
  if (sizes.size() != 3) return std::nullopt;
  return Form{colours ? Pixels::kRgb : Pixels::kGrey, colours ? 3U : 1U, sizes[0], sizes[1], sizes[2]};
}

std::optional<Form> form_of(std::string_view field) {
  if (field.starts_with(kFinal)) field.remove_prefix(kFinal.size());
  if (field == "screen") return Form{Pixels::kIndices, 1, kWidth};
  if (field == "rgb") return Form{Pixels::kRgb, 3, kWidth};
  if (field == "grey") return Form{Pixels::kGrey, 1, kWidth};
  return resized_form(field);
}

using Fits = std::function<bool(std::size_t bytes)>;

// The bytes of a text in the one encoding that gives as many as `fits` accepts.
Bytes decoded(std::string_view field, std::string_view text, const Fits& fits) {
  constexpr std::array<std::string_view, 4> kTried = {"hex", "rle", "base64", "zlib"};
  std::vector<std::pair<std::string_view, Bytes>> found;
  for (const std::string_view name : kTried) {
    try {
      Bytes bytes = client::decode(*client::encoding_of(name), text);
      if (fits(bytes.size())) found.emplace_back(name, std::move(bytes));
    } catch (const std::invalid_argument&) {
      continue;  // it is another one
    }
  }
  if (found.size() == 1) return std::move(found[0].second);
  const std::string subject = "the value of " + std::string(field);
  if (found.empty())
    throw std::invalid_argument(subject +
                                " is not a whole screen in hex, rle, base64 or zlib; it may be cut, or need "
                                "--encoding delta");
  throw std::invalid_argument(subject + " may be " + std::string(found[0].first) + " or " +
                              std::string(found[1].first) + "; --encoding says which");
}

class Replies {
 public:
  explicit Replies(const PictureRequest& request) : request_(request) {}

  void take(std::string line, std::istream& input) {
    while (line.ends_with('\r')) line.pop_back();
    if (line.starts_with("error ") && refusal_.empty()) refusal_ = line.substr(6);
    if (line != "ok" && !line.starts_with("ok ")) return;
    const client::Reply reply(std::move(line), [](Group::Value&, std::size_t) {});
    follow(reply.first());
    read_raw(reply, input);
    std::size_t behind = 0;  // bytes of raw_ before the value
    bool has_picture = false;
    for (std::size_t group = 0; group < reply.groups().size(); ++group) {
      for (const Group::Value& value : reply.groups()[group].values()) {
        const std::size_t count = raw_size(value);
        const std::string_view raw = std::string_view(raw_).substr(std::min(behind, raw_.size()), count);
        behind += count;
        if (value.key == "palette")
          palette_ = bytes_of(value, raw, [](auto size) { return size == kPalette; });
        if (has_picture || !is_wanted(value, group)) continue;
        has_picture = true;
        see(value, raw, group);
      }
    }
  }

  ReplyPicture picture() && {
    if (seen_) {
      seen_->palette = std::move(palette_);
      seen_->format = std::move(format_);
      return std::move(*seen_);
    }
    std::string sentence = "no reply on standard input has " +
                           (request_.field.empty() ? "a picture, such as screen, rgb or grey84x84x4"
                                                   : "the field " + request_.field);
    if (!refusal_.empty()) sentence += "; the server refused a request: " + refusal_;
    throw std::invalid_argument(sentence);
  }

 private:
  // What the replies of load, observe and watch say about later ones.
  void follow(const Group& first) {
    const auto text = [&first](std::string_view key) { return first.has(key) ? first.text(key) : ""; };
    if (const auto height = number(text("height")); height && first.has("game")) height_ = *height;
    if (!text("format").empty()) format_ = text("format");
    if (first.has("md5") || first.has("fields")) arrays_.clear();
  }

  // The bytes that follow a reply.
  void read_raw(const client::Reply& reply, std::istream& input) {
    raw_.clear();
    const Group& last = reply.groups().back();
    if (!last.has("raw")) return;
    const auto count = number(last.text("raw"));
    if (!count || *count > kMaxRaw) throw std::invalid_argument("a reply says raw=" + last.text("raw"));
    raw_.resize(*count);
    if (!input.read(raw_.data(), static_cast<std::streamsize>(*count)))
      throw std::invalid_argument("the input ends within the bytes that follow a reply");
  }

  // How many of these bytes belong to a value.
  std::size_t raw_size(const Group::Value& value) const {
    const auto count = raw_.empty() ? std::nullopt : number(value.text);
    if (!count) return 0;
    const auto form = form_of(value.key);
    const bool is_size =
        form ? fits(*form, *count) : std::ranges::any_of(client::detail::kSizes, [&](const auto& size) {
          return size.first == value.key && size.second == *count;
        });
    return is_size ? *count : 0;
  }

  bool fits(const Form& form, std::size_t bytes) const {
    if (form.height > 0) return bytes == form.size(form.height);
    if (height_) return bytes == form.size(*height_);
    return bytes % form.size(1) == 0 && bytes >= form.size(kMinHeight) && bytes <= form.size(kMaxHeight);
  }

  bool is_wanted(const Group::Value& value, std::size_t group) const {
    if (request_.machine >= 0 && group != static_cast<std::size_t>(request_.machine) + 1) return false;
    if (!request_.field.empty()) return value.key == request_.field;
    if (value.key == "data") return value.text.starts_with(kPngInBase64);
    return !value.key.starts_with(kFinal) && form_of(value.key);
  }

  static Bytes bytes_of(const Group::Value& value, std::string_view raw, const Fits& fits) {
    if (!raw.empty()) return {raw.begin(), raw.end()};
    return decoded(value.key, value.text, fits);
  }

  void see(const Group::Value& value, std::string_view raw, std::size_t group) {
    ReplyPicture& picture = seen_.emplace();
    if (value.text.starts_with(kPngInBase64)) {
      picture.pixels = Pixels::kFile;
      picture.bytes = client::from_base64(value.text);
      return;
    }
    const auto form = form_of(value.key);
    if (!form) throw std::invalid_argument(request_.field + " is not a picture");
    picture.pixels = form->pixels;
    picture.width = form->width;
    picture.resized = form->height > 0;
    picture.bytes = request_.encoding.empty()
                        ? bytes_of(value, raw, [&](std::size_t size) { return fits(*form, size); })
                        : encoded(value, raw, *form, group);
    if (picture.bytes.empty() || !fits(*form, picture.bytes.size()))
      throw std::invalid_argument("the value of " + std::string(value.key) + " has " +
                                  std::to_string(picture.bytes.size()) +
                                  " bytes, which is not a whole screen");
    picture.height = picture.bytes.size() / form->size(1) * form->screens;
  }

  // In the encoding that the caller says.
  Bytes encoded(const Group::Value& value, std::string_view raw, const Form& form, std::size_t group) {
    const Encoding encoding = *client::encoding_of(request_.encoding);
    if (encoding == Encoding::kRaw) return {raw.begin(), raw.end()};
    if (encoding != Encoding::kDelta) return client::decode(encoding, value.text);
    Bytes& array = arrays_[{std::string(value.key), group}];
    array.resize(form.size(form.height > 0 ? form.height : height_.value_or(kUsualHeight)));
    client::apply_delta(array, value.text);
    return array;
  }

  const PictureRequest& request_;
  std::optional<std::size_t> height_;  // of the screen, if a reply has said it
  std::string format_, refusal_, raw_;
  Bytes palette_;
  std::map<std::pair<std::string, std::size_t>, Bytes> arrays_;  // what deltas have made, by field and group
  std::optional<ReplyPicture> seen_;
};

}  // namespace

bool is_reply(std::string_view line) {
  return line == "ok" || line.starts_with("ok ") || line.starts_with("error ");
}

ReplyPicture last_picture(std::string line, std::istream& input, const PictureRequest& request) {
  Replies replies(request);
  do replies.take(std::move(line), input);
  while (std::getline(input, line));
  return std::move(replies).picture();
}

}  // namespace racebeam
