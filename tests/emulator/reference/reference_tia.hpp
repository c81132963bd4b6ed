// A second TIA, written only from docs/spec/tia.md. It draws clock by clock and pixel by pixel, at the
// moments that the specification gives. Slow and simple, and independent of emulator/. The machine is
// compared with it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace racebeam {
struct TiaState;
}

namespace racebeam::test {

class ReferenceTia {
 public:
  struct Window {
    int ystart = 34, height = 210;
    bool hmove_blanks = true, pal = false;
  };
  using Buffer = std::vector<std::uint8_t>;

  explicit ReferenceTia(const Window& window);

  void open_frame(int T);  // section 2, action 1; what was T becomes 0
  void reset_in_frame();   // section 13, the frame staying open
  void write(int T, unsigned reg, std::uint8_t value);
  unsigned read(int T, unsigned reg);  // D7 and D6 of $00-$07
  void touch(int T) { draw_to(3 * T); }

  int origin() const { return F_; }
  const std::array<Buffer, 2>& buffers() const { return buffer_; }
  int current() const { return current_; }
  void take_machine_of(const ReferenceTia& other);  // everything but the two buffers

  // The differences between the two machines, in words; empty if all is equal.
  std::string difference(const TiaState& tia) const;
  void meet(unsigned packed);  // sets the latches from two bits a collision register

 private:
  enum Object { P0, P1, M0, M1, BL, PF, kObjectCount };

  struct Player {
    int grp = 0, old = 0, refp = 0, vdel = 0, mode = 0, pos = 0, hm = 0;
    bool skip = false;
  };
  struct Missile {
    int enam = 0, resmp = 0, size = 0, pos = 0, hm = 0;
  };
  struct Ball {
    int enabl = 0, old = 0, vdel = 0, size = 0, pos = 0, hm = 0;
  };
  enum class Shape { Normal, Stretched, Hidden };

  static constexpr Object kObjects[] = {P0, P1, M0, M1, BL, PF};

  void draw_to(int k);
  void draw_pixels(int first, int count);
  void draw_pixel(int p, std::uint8_t* at);
  void end_line();
  bool group_rule() const;
  bool group_is_clear(int p) const;

  int graphics(const Player& player) const;
  bool enabled(Object object) const;
  int player_bit(const Player& player, int p) const;  // 0-7, or -1 outside of its shape
  bool shape(Object object, int p) const;
  bool active(Object object, int p) const;
  std::uint8_t color_of(const std::array<bool, kObjectCount>& on, int p) const;

  static int mod(int a, int b) { return (a % b + b) % b; }
  int h(int c) const { return mod(c - F_, 228); }
  static const std::vector<int>& offsets(int mode);  // of the copies
  void strobe_player(Player& player, int c);
  void strobe_missile(int i, int c);
  void strobe_ball(int c);
  void strobe_hmove(int c);
  void release(int i);
  void apply(int c, unsigned reg, std::uint8_t v);

  Window window_;
  int F_ = 0, S_ = 0, W_ = 0, L_ = 0, E_ = 228, pointer_ = 0;
  std::array<Player, 2> player_;
  std::array<Missile, 2> missile_;
  Ball ball_;
  std::array<int, 3> pf_{};
  std::array<int, 4> color_{};  // COLUP0 COLUP1 COLUPF COLUBK
  int ctrlpf_ = 0, reflect_ = 0;
  bool vblank_ = false, blank_armed_ = false;
  bool cosmic_ = false;
  int counter_ = 0;
  Shape m0_shape_ = Shape::Normal;
  int last_hmove_ = 0;
  int lines_of_frame_ = 0;
  std::array<std::array<bool, kObjectCount>, kObjectCount> collided_{};
  std::array<bool, kObjectCount> enabled_{};  // while pixels are drawn: of the registers as they stand
  std::array<Buffer, 2> buffer_;
  int current_ = 0;
};

}  // namespace racebeam::test
