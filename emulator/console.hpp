// The console: a board with a cartridge and three chips, run frame by frame (docs/spec/console.md;
// docs/spec/tia.md, 2).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "emulator/pace.hpp"
#include "emulator/state/inputs.hpp"
#include "emulator/state/power_on.hpp"
#include "emulator/state/properties.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/frame_buffer.hpp"
#include "emulator/tia/sound.hpp"
#include "emulator/translator/translator.hpp"

namespace racebeam {

class Console {
 public:
  // Builds the console around an image, as docs/spec/console.md, 1 says: power-on RAM, format detection,
  // system reset. Throws InvalidInput if no cartridge scheme fits the image. power_on: must outlive the
  // console. cpu: executes the instructions. For kTranslator, throws std::system_error where code cannot be
  // translated. pace: is notified of every step, including those of format detection, and must outlive the
  // console. Null: none.
  Console(std::shared_ptr<const std::vector<std::uint8_t>> rom, const Properties& properties,
          PowerOn& power_on, CpuKind cpu = CpuKind::kAuto, Pace* pace = nullptr);
  ~Console();

  void reset();  // system reset, docs/spec/console.md, 2

  // Runs until a frame closes (docs/spec/tia.md, 2). draw: the caller will read the picture. If false,
  // rendering may be deferred: the state is identical, and picture() renders on demand. A deferred frame is
  // still drawn if that takes less time, unless `follow` forbids it.
  void step(bool draw = true, bool follow = false);

  Inputs& inputs();  // positions of controllers and switches during the next steps
  Sound& sound();
  const Sound& sound() const;
  const State& state() const;  // the whole machine, one trivially copyable value

  // The cartridge's RAM if it has more than 256 bytes, which do not fit into `state`; otherwise empty. It
  // belongs to a saved state.
  std::span<const std::uint8_t> cartridge_ram() const;

  // Restores the machine, but no pictures: undrawn rows keep their pixels. Throws InvalidInput, and changes
  // nothing, if `cartridge_ram` does not have this console's size.
  void restore(const State& state, std::span<const std::uint8_t> cartridge_ram = {});

  // Throws InvalidInput, with the name of the field, if this machine cannot be in `state`. A state that
  // passes can be restored and run, whatever its source.
  void check(const State& state, std::span<const std::uint8_t> cartridge_ram = {}) const;

  Format format() const;     // kNtsc, kPal, kPal60 or kSecam: detected, or from the properties
  bool has_paddles() const;  // in either port
  int height() const;        // rows of picture(): the picture's height, at least 200
  std::span<const std::uint8_t> picture() const;           // height() x 160 palette indices, drawn last
  std::span<const std::uint8_t> previous_picture() const;  // the picture before it
  // Which line each row of these pictures shows, at least height() of them. Rows of all pictures and machines
  // that show the same line have the same pixels. kAnyLine says nothing about the pixels.
  std::span<const LineNumber> picture_lines() const;
  std::span<const LineNumber> previous_picture_lines() const;
  bool frame_is_open() const;  // the next step continues it, in the same picture

  // Both buffers in their order, for a saved state; undrawn ones as they are. They are shared until the
  // console draws on one of them again, so that saving and restoring copy no pixels. Restored pictures must
  // come from a console with the same image and properties.
  const FrameBuffers& pictures() const;
  void restore_pictures(const FrameBuffers& pictures);

  // Releases caches that only make drawing faster, half of a console's memory. For a console that will not
  // run for a while; the next frames allocate them again.
  void release_caches();

  // Bytes of memory for pictures, records of lines and the cartridge's RAM. The rest is the same for all
  // consoles. A picture that a saved state holds too counts in full.
  std::size_t footprint() const;

  // A picture of a saved state with its pixels: the same buffer, or a drawn copy.
  std::shared_ptr<const FrameBuffer> with_pixels(std::shared_ptr<FrameBuffer> picture) const;

  // Cycles that the translator has left to the interpreter, including those of repeated steps. 0 without it.
  std::int64_t interpreted_cycles() const;

  std::span<const std::uint8_t, 128> ram() const;  // $80-$FF
  // Read and write a byte of RAM, 0 to 127, over the data bus, where the byte stays (docs/spec/console.md,
  // 4).
  std::uint8_t read_ram(int index);
  void set_ram(int index, std::uint8_t value);
  // Returns a byte of RAM or of the cartridge without side effects; 0 for other addresses.
  std::uint8_t peek(std::uint16_t address) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace racebeam
