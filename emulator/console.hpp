// The board: a cartridge, the three chips, and the frame (docs/spec/console.md; docs/spec/tia.md, 2).
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
  // system reset. Throws InvalidInput when no cartridge scheme fits the image. `power_on` must
  // outlive the console. cpu: what runs the instructions; kTranslator throws std::system_error where code
  // can't be translated. pace: is told of every step, those of format detection too, and must outlive the
  // console; null: none.
  Console(std::shared_ptr<const std::vector<std::uint8_t>> rom, const Properties& properties, PowerOn& power_on,
          CpuKind cpu = CpuKind::kAuto, Pace* pace = nullptr);
  ~Console();

  void reset();  // system reset, docs/spec/console.md, 2

  // Runs until a frame closes (docs/spec/tia.md, 2). draw: its picture will be looked at. Without, all is the
  // same and picture() too, but it must then run the frame again: what will mostly not be looked at costs
  // less. Where drawing costs less all the same, it is drawn, unless it is to be followed in any case.
  void step(bool draw = true, bool follow = false);

  Inputs& inputs();               // what is pressed from now on
  Sound& sound();
  const Sound& sound() const;
  const State& state() const;     // the whole machine, one trivially copyable value

  // RAM on the cartridge that `state` has no room for (E7, 3E, CV, AR, MC); mostly empty. It belongs to a saved state.
  std::span<const std::uint8_t> cartridge_ram() const;

  // The machine alone: exact in everything but what undrawn rows of the two pictures show. Throws
  // InvalidInput, and changes nothing, when `cartridge_ram` is not as large as this console's.
  void restore(const State& state, std::span<const std::uint8_t> cartridge_ram = {});

  // Throws InvalidInput, naming the field, when this machine can't be in `state`. What passes can be restored
  // and run, whoever wrote it.
  void check(const State& state, std::span<const std::uint8_t> cartridge_ram = {}) const;

  Format format() const;          // kNtsc, kPal, kPal60 or kSecam: detected, or from the properties
  bool has_paddles() const;       // either port
  int height() const;             // rows given out: the picture's height, at least 200
  std::span<const std::uint8_t> picture() const;           // height() x 160 palette indices, drawn last
  std::span<const std::uint8_t> previous_picture() const;  // the picture before it

  // Both buffers with their order, for a snapshot; undrawn ones as they are. They are shared until the console draws on
  // one of them again, so that taking and putting back cost nothing. What is put back must come from a console with the
  // same image and properties.
  const FrameBuffers& pictures() const;
  void restore_pictures(const FrameBuffers& pictures);

  // Gives back what only makes drawing faster, half of a console's memory: for one that will not run for a while. It
  // comes back with the next frames.
  void rest();

  // A picture of such a snapshot with its pixels: the same, or a copy that has been drawn.
  std::shared_ptr<const FrameBuffer> drawn(std::shared_ptr<FrameBuffer> picture) const;

  std::span<const std::uint8_t, 128> ram() const;  // $80-$FF
  void set_ram(int index, std::uint8_t value);
  std::uint8_t peek(std::uint16_t address) const;  // RAM and cartridge, without any side effect; 0 elsewhere

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace racebeam
