#include "server/web/page_files.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "server/web/embedded_page.hpp"

namespace racebeam {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kTypes = {{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".txt", "text/plain; charset=utf-8"},
}};

std::string_view type_of(std::string_view path) {
  for (const auto& [end, type] : kTypes) {
    if (path.ends_with(end)) return type;
  }
  return "application/octet-stream";
}

std::string gzip(std::string_view bytes) {
  constexpr int kGzip = 16 + MAX_WBITS, kMaxMemory = 9;
  z_stream stream{};
  const std::unique_ptr<z_stream, int (*)(z_stream*)> ended(&stream, deflateEnd);
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzip, kMaxMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("zlib cannot compress the page");
  std::string out(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  return out;
}

std::vector<PageFile> all_files() {
  std::vector<PageFile> files;
  for (const EmbeddedFile& file : embedded_page()) {
    std::string tag(1, '"');
    (tag += file.digest) += '"';
    files.push_back({file.path, type_of(file.path), std::move(tag), file.bytes, gzip(file.bytes)});
  }
  return files;
}

}  // namespace

const PageFile* find_page_file(std::string_view path) {
  static const std::vector<PageFile> files = all_files();
  const auto found = std::ranges::find(files, path == "/" ? "/index.html" : path, &PageFile::path);
  return found == files.end() ? nullptr : &*found;
}

}  // namespace racebeam
