// The functions of racebeam.wasm: sessions of the line protocol in one process. ../src/wasm/local.js calls
// them.
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "games/images.hpp"
#include "protocol/line_session.hpp"
#include "system/invalid_input.hpp"
#include "system/resources.hpp"

#define EXPORTED(name) [[clang::export_name(name)]]

namespace racebeam {
namespace {

// Nothing else runs while a function of these does, so that images may be added.
std::shared_ptr<Images> images() {
  static const auto all = std::make_shared<Images>();
  return all;
}

LineService make_service() {
  LineService service;
  service.version = RACEBEAM_VERSION;
  service.images = images();
  service.memory = std::make_shared<MemoryBudget>(usable_memory("").amount / 2);
  return service;
}

std::string replies;  // of the last run() or add_image()
std::string files;    // of the next add_image()

// The game of the game file that may lie beside an image; null without one.
std::shared_ptr<const Game> game_beside(std::string_view name, std::string_view text) {
  return name.empty() ? nullptr : game_in_file(text, std::string(name));
}

// The reply to a request for adding an image, in the form of the line protocol.
std::string added(std::string_view name, std::string_view image, std::string_view game_name,
                  std::string_view game) {
  try {
    const Cartridge& cartridge =
        images()->put(image_in_file(image, std::string(name)), game_beside(game_name, game));
    return "ok md5=" + cartridge.image->md5 + " game=" + cartridge.game->name + "\n";
  } catch (const InvalidInput& error) {
    return std::string("error bad-image ") + error.what() + "\n";
  }
}

}  // namespace

EXPORTED("open_session") LineSession* open_session() {
  static const LineService service = make_service();
  return new LineSession(service);
}

EXPORTED("close_session") void close_session(LineSession* session) { delete session; }

// Where the next bytes of requests go: room() of them at most.
EXPORTED("space") char* space(LineSession* session) { return session->space().data(); }
EXPORTED("room") std::uint32_t room(LineSession* session) {
  return static_cast<std::uint32_t>(session->space().size());
}

// Executes the requests of which `count` more bytes, 1 or more, lie in space(). Returns the size of the
// replies, which stay until the next call.
EXPORTED("run") std::uint32_t run(LineSession* session, std::uint32_t count) {
  session->received(count);
  replies.clear();
  for (bool more = true; more;) {
    more = session->run();
    const std::string_view output = session->output();
    replies += output;
    session->sent(output.size());
  }
  return static_cast<std::uint32_t>(replies.size());
}

// Where the next add_image() finds its names and contents, in a row.
EXPORTED("file_space") char* file_space(std::uint32_t size) {
  files.resize(size);
  return files.data();
}

// Adds an image for all sessions. The sizes are those of its file's name and contents, and of the name of its
// game file, if it has one; the rest are the contents of that. Returns the size of the reply, as run() does.
EXPORTED("add_image")
std::uint32_t add_image(std::uint32_t name, std::uint32_t image, std::uint32_t game_name) {
  std::string_view rest = files;
  const auto next = [&rest](std::size_t size) {
    const std::string_view taken = rest.substr(0, size);
    rest.remove_prefix(size);
    return taken;
  };
  const std::string_view name_of_image = next(name), bytes = next(image), name_of_game = next(game_name);
  replies = added(name_of_image, bytes, name_of_game, rest);
  return static_cast<std::uint32_t>(replies.size());
}

EXPORTED("replies") const char* last_replies() { return replies.data(); }

// Whether the session has ended, so that it takes no more requests.
EXPORTED("finished") bool finished(LineSession* session) { return session->finished(); }

}  // namespace racebeam
