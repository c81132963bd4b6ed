#include "tests/protocol/effect_cases.hpp"

#include "protocol/encoding/base64.hpp"
#include "tests/protocol/duel.hpp"

namespace racebeam::test {

const std::string kLoadDuel = "load duel seed=7 sticky=0";
const std::string kToken = "open-sesame";

std::string counter_as_text(int unused_byte) {
  auto bytes = *counter_image()->bytes;
  bytes[0x800] = static_cast<std::uint8_t>(unused_byte);
  std::string text;
  append_base64(text, bytes);
  return text;
}

namespace {

std::string state_as_text() {
  LineClient client(duel_service());
  client.say(kLoadDuel + "\nact NOOP*9\nsave a\n");
  return value(client.ask("export a"), "data");
}

const std::string kAlternating = "act RIGHT NOOP RIGHT NOOP RIGHT NOOP RIGHT NOOP",
                  kTetris = "load beamfall as=tetris seed=7 sticky=0",
                  kSticky = "load duel seed=7 sticky=0.5",
                  kAfterSave = "act RIGHT NOOP*9\nrestore a\nsave b generator=1\nexport b",
                  kEnds = "load duel seed=7 sticky=0 max_episode_frames=2\nobserve episode_frame ends",
                  kThreeSteps = "step NOOP\nstep NOOP\nstep NOOP",
                  kTwoPlaces = "open 2\nobserve ram\nstep RIGHT NOOP\nact LEFT*9\n",
                  kOpen = "open 2\nobserve episode_frame\nstep NOOP";

const std::string
    kOtherSticky = "load duel seed=8 sticky=0.5",
    kManySticky = "load duel seed=8 sticky=0.5 frame_skip=20\nopen 9\n",
    kFrames = "load beamfall seed=7 sticky=0 frame_skip=4 noop_max=30\nobserve ram\n",
    kLongSteps = "load beamfall seed=7 sticky=0 frame_skip=900\nobserve ends lives episode_frame\n",
    kStart = "open 1 steps=frames start=", kLives = "open 1 steps=frames life_loss=",
    kStacked = "load beamfall seed=7 sticky=0 frame_skip=4\nobserve grey84x3:hex\nopen 1 steps=frames ";

const std::string kShot = "load beamfall seed=7 sticky=0 frame_skip=20\nopen 2\nact FIRE\nstep RIGHT LEFT";

const std::string kUneven = "load duel seed=7 sticky=0 frame_skip=1-9\nopen 2\n",
                  kFourSteps = "step NOOP\nstep NOOP\nstep NOOP\nstep NOOP\nrecord stop";

const Cases kWithoutGame = {
    {"hello", "hello token=" + kToken, "", "stats"},
    {"hello token", "hello token=" + kToken, "hello", "stats"},
    {"hello TOKEN", "hello token=" + kToken, "hello token=guess", "stats"},
};

const Cases kWithDuel = {
    {"help", "help", "stats"},
    {"help COMMAND", "help act", "help load"},
    {"help KEY", "help sticky", "help seed"},
    {"help settings", "help settings", "help presets"},
    {"help presets", "help presets", "help fields"},
    {"help fields", "help fields", "help encodings"},
    {"help encodings", "help encodings", "help errors"},
    {"help errors", "help errors", "help states"},
    {"help states", "help states", "help settings"},
    {"games", "games", "stats"},
    {"games all", "games all", "games"},
    {"games GAME", "games pong", "games boxing"},
    {"load", "load beamfall", "", "settings"},
    {"load GAME", "load beamfall", "load updraft", "settings"},
    {"load MD5", "load 8b96297bc95db74738674ce177f501c1", "", "settings"},
    {"load inline", "load inline image=" + counter_as_text(), "", "settings"},
    {"load image", "load inline image=" + counter_as_text(), "load inline", "settings"},
    {"load BASE64", "load inline image=" + counter_as_text(), "load inline image=AAAA", "settings"},
    {"load as", "load duel as=boxing", "load duel", "modes"},
    {"load KEY", "load duel seed=1 difficulty=1", "load duel seed=1 mode=0", "settings"},
    {"load VALUE", "load duel seed=1", "load duel seed=2", "settings"},
    {"settings", "settings", "stats"},
    {"set", "set difficulty=1\nact NOOP", "act NOOP", "look ram"},
    {"set mode", "set mode=2\nreset", "reset", "look ram"},
    {"set difficulty", "set difficulty=1\nact NOOP", "act NOOP", "look ram"},
    {"set N", "set difficulty=1", "set difficulty=2", "difficulties"},
    {"modes", "modes", "load beamfall\nmodes"},
    {"difficulties", "difficulties", "load beamfall\ndifficulties"},
    {"names", "names", "load beamfall\nnames"},
    {"actions", "actions", "load beamfall\nactions"},
    {"observe", "observe frame", "", "act NOOP"},
    {"observe FIELD", "observe frame", "observe lives", "act NOOP"},
    {"observe ENCODING", "observe ram:hex", "observe ram:base64", "act NOOP"},
    {"observe none", "observe none", "", "act NOOP"},
    {"look", "observe frame\nact NOOP\nlook", "observe frame\nlook"},
    {"look FIELD", "look frame", "look lives"},
    {"look ENCODING", "look ram:hex", "look ram:base64"},
    {"act", "act NOOP", "", "look frame"},
    {"act A", "act RIGHT", "act LEFT"},
    {"act STRENGTH", "load beamfall as=breakout\nact RIGHT@0.5*20", "load beamfall as=breakout\nact RIGHT*20",
     "save a\nexport a"},
    {"act B", "act NOOP/RIGHT", "act NOOP", "look reward_b"},
    {"act TIMES", "act RIGHT*3", "act RIGHT"},
    {"reset", "act NOOP\nreset", "act NOOP", "look episode_frame"},
    {"reset seed", kOtherSticky + "\nreset seed=9", kOtherSticky + "\nreset", kAlternating},
    {"reset random", kOtherSticky + "\nreset seed=random", kOtherSticky + "\nreset seed=8", "settings"},
    {"reset N", kOtherSticky + "\nreset seed=9", kOtherSticky + "\nreset seed=10", kAlternating},
    {"peek", "peek 0", "poke 0 12\npeek 0"},
    {"peek INDEX", "peek 0", "peek 40"},
    {"peek COUNT", "peek 0 2", "peek 0"},
    {"poke", "poke 40 12", "", "look ram"},
    {"poke INDEX", "poke 40 12", "poke 41 12", "look ram"},
    {"poke HEX", "poke 40 12", "poke 40 1213", "look ram"},
    {"save", "save a", "", "restore a"},
    {"save NAME", "save a", "save b", "restore a"},
    {"save generator", kSticky + "\nsave a generator=1", kSticky + "\nsave a", kAfterSave},
    {"save 1", kSticky + "\nsave a generator=1", kSticky + "\nsave a generator=0", kAfterSave},
    {"restore", "save a\nact NOOP\nrestore a", "save a\nact NOOP", "look frame"},
    {"restore NAME", "save a\nact NOOP\nsave b\nrestore a", "save a\nact NOOP\nsave b\nrestore b",
     "look frame"},
    {"save machine", kTwoPlaces + "save a machine=1", kTwoPlaces + "save a", "restore a\nlook ram"},
    {"save N", kTwoPlaces + "save a machine=1", kTwoPlaces + "save a machine=0", "restore a\nlook ram"},
    {"restore machine", kTwoPlaces + "save a\nrestore a machine=1", kTwoPlaces + "save a\nrestore a",
     "step NOOP"},
    {"restore N", kTwoPlaces + "save a\nrestore a machine=1", kTwoPlaces + "save a\nrestore a machine=0",
     "step NOOP"},
    {"drop", "save a\ndrop a", "save a", "states"},
    {"drop NAME", "save a\nsave b\ndrop a", "save a\nsave b\ndrop b", "states"},
    {"drop all", "save a\nsave b\ndrop all", "save a\nsave b\ndrop b", "states"},
    {"states", "save a\nstates", "save b\nstates"},
    {"share", "share room", "", "shared"},
    {"share NAME", "share room", "share hall", "shared"},
    {"share watchers", "share room watchers=4", "share room"},
    {"share N", "share room watchers=4", "share room watchers=5"},
    {"unshare", "share room\nunshare", "share room", "shared"},
    {"shared", "share room\nshared", "shared"},
    {"watch", "share room\nwatch room", "act NOOP*9\nshare room\nwatch room"},
    {"watch NAME", "share room\nwatch room", "share room\nwatch hall"},
    {"watch since", "share room\nwatch room since=0 ram", "share room\nwatch room ram"},
    {"watch FRAME", "share room\nwatch room since=0 ram", "share room\nwatch room since=9 ram"},
    {"watch FIELD", "share room\nwatch room ram", "share room\nwatch room screen"},
    {"watch ENCODING", "share room\nwatch room ram:hex", "share room\nwatch room ram:base64"},
    {"export", "save a\nexport a", "act NOOP\nsave a\nexport a"},
    {"export NAME", "save a\nact NOOP\nsave b\nexport a", "save a\nact NOOP\nsave b\nexport b"},
    {"export episode", "save a\nexport a episode=1", "save a\nexport a"},
    {"export 1", "save a\nexport a episode=1", "save a\nexport a episode=0"},
    {"import", "import a " + state_as_text(), "save a", "restore a\nlook ram"},
    {"import NAME", "import a " + state_as_text(), "import b " + state_as_text(), "states"},
    {"import BASE64", "import a " + state_as_text(), "import a AAAA", "restore a"},
    {"branch", "save a\nbranch a RIGHT", "save a\nbranch a NOOP"},
    {"branch NAME", "save a\npoke 17 01\nact NOOP\nsave b\nbranch a RIGHT",
     "save a\npoke 17 01\nact NOOP\nsave b\nbranch b RIGHT"},
    {"branch keep", "save a\nbranch a keep=x RIGHT", "save a\nbranch a RIGHT", "restore x0"},
    {"branch PREFIX", "save a\nbranch a keep=x RIGHT", "save a\nbranch a keep=y RIGHT", "restore x0"},
    {"branch ACTION", "save a\nbranch a RIGHT,RIGHT", "save a\nbranch a RIGHT"},
    {"open", "open 2", "", "step RIGHT"},
    {"open N", "open 2", "open 3", "step RIGHT"},
    {"open autoreset", kEnds + "\nopen 1 autoreset=disabled", kEnds + "\nopen 1", kThreeSteps},
    {"open next-step", kEnds + "\nopen 1 autoreset=next-step", kEnds + "\nopen 1 autoreset=disabled",
     kThreeSteps},
    {"open same-step", kEnds + "\nopen 1 autoreset=same-step", kEnds + "\nopen 1 autoreset=next-step",
     kThreeSteps},
    {"open disabled", kEnds + "\nopen 1 autoreset=disabled", kEnds + "\nopen 1 autoreset=same-step",
     kThreeSteps},
    {"open steps", kFrames + "open 1 steps=frames", kFrames + "open 1", "step NOOP"},
    {"open acts", kFrames + "open 1 steps=acts", kFrames + "open 1 steps=frames", "step NOOP"},
    {"open frames", kFrames + "open 1 steps=frames", kFrames + "open 1 steps=acts", "step NOOP"},
    {"open start", kFrames + kStart + "baselines", kFrames + "open 1 steps=frames", "step NOOP"},
    {"open fire-noops", kFrames + kStart + "fire-noops", kFrames + kStart + "noops", "step NOOP"},
    {"open noops-fire", kFrames + kStart + "noops-fire", kFrames + kStart + "fire-noops", "step NOOP"},
    {"open baselines", kFrames + kStart + "baselines", kFrames + kStart + "noops-fire", "step NOOP"},
    {"open noops", kFrames + kStart + "noops", kFrames + kStart + "baselines", "step NOOP"},
    {"open life_loss", kLongSteps + kLives + "reported", kLongSteps + "open 1 steps=frames", "step FIRE"},
    {"open ignored", kLongSteps + kLives + "ignored", kLongSteps + kLives + "reported", "step FIRE"},
    {"open reported", kLongSteps + kLives + "reported", kLongSteps + kLives + "ignored", "step FIRE"},
    {"open end", kLongSteps + kLives + "end", kLongSteps + kLives + "restart", "step FIRE\nstep FIRE"},
    {"open restart", kLongSteps + kLives + "restart", kLongSteps + kLives + "reported",
     "step FIRE\nstep FIRE"},
    {"open stack", kStacked + "stack=repeats", kStacked, "restart"},
    {"open zeros", kStacked + "stack=zeros", kStacked + "stack=repeats", "restart"},
    {"open repeats", kStacked + "stack=repeats", kStacked + "stack=zeros", "restart"},
    {"open pool", kStacked + "pool=0", kStacked, "step FIRE\nstep RIGHT"},
    {"open 0", kStacked + "pool=0", kStacked + "pool=1", "step FIRE\nstep RIGHT"},
    {"open 1", kStacked + "pool=1", kStacked + "pool=0", "step FIRE\nstep RIGHT"},
    {"step", kOpen + "\nstep NOOP", kOpen, "step NOOP"},
    {"step ACTION", "open 2\nstep RIGHT NOOP", "open 2\nstep NOOP RIGHT"},
    {"restart", kOpen + "\nrestart", kOpen, "step NOOP"},
    {"restart MASK", kOpen + "\nrestart 10", kOpen + "\nrestart 01", "step NOOP"},
    {"restart seed", kManySticky + "restart seed=9", kManySticky + "restart", "step NOOP\nstep RIGHT"},
    {"restart random", kManySticky + "restart seed=random", kManySticky + "restart seed=8",
     "step NOOP\nstep RIGHT"},
    {"restart N", kManySticky + "restart seed=9", kManySticky + "restart seed=30", "step NOOP\nstep RIGHT"},
    {"close", "open 2\nclose", "open 2", "stats"},
    {"record", "", "record gif a", "record gif b"},
    {"record png", "record png a", "record gif a"},
    {"record gif", "record gif a", "record y4m a"},
    {"record y4m", "record y4m a", "record gif a"},
    {"record webm", "record webm a", "record mp4 a"},
    {"record mp4", "record mp4 a", "record gif a"},
    {"record wav", "load duel sound=1\nrecord wav a", "load duel sound=1\nrecord gif a"},
    {"record NAME", "record gif a", "record gif b"},
    {"record machine", kUneven + "record png a machine=1", kUneven + "record png a", kFourSteps},
    {"record N", kUneven + "record png a machine=1", kUneven + "record png a machine=0", kFourSteps},
    {"record stop", "record gif a\nact NOOP*4\nrecord stop", "record gif a\nact NOOP*4", "record gif b"},
    {"shot", kShot + "\nshot", "stats"},
    {"shot NAME", "shot a", "shot b"},
    {"shot machine", kShot + "\nshot machine=1", kShot + "\nshot"},
    {"shot N", kShot + "\nshot machine=1", kShot + "\nshot machine=0"},
    {"stats", "stats", "act NOOP\nstats"},
    {"quit", "quit", "stats"},
};

// `load` with a setting, and with another value of it.
const Cases kSettings = {
    {"preset", kLoadDuel + " preset=dqn2015", kLoadDuel + " preset=none", "observe frames\nact NOOP"},
    {"seed", "load duel seed=8 sticky=0.5", "load duel seed=9 sticky=0.5", kAlternating},
    {"system_seed", kLoadDuel + " system_seed=1", kLoadDuel + " system_seed=2", "look ram"},
    {"frame_skip", kLoadDuel + " frame_skip=2", kLoadDuel + " frame_skip=1", "observe frames\nact NOOP"},
    {"sticky", "load duel seed=8 sticky=0.5", "load duel seed=8 sticky=0", kAlternating},
    {"mode", kLoadDuel + " mode=2", kLoadDuel + " mode=0", "look ram"},
    {"difficulty", kLoadDuel + " difficulty=1", kLoadDuel + " difficulty=0", "act NOOP\nlook ram"},
    {"max_episode_frames", kLoadDuel + " max_episode_frames=2", kLoadDuel + " max_episode_frames=0",
     "act NOOP*3"},
    {"life_loss", kLoadDuel + " life_loss=restart", kLoadDuel + " life_loss=reported",
     "observe acts\npoke 18 01\nact NOOP*9"},
    {"life_loss_ends", kLoadDuel + " life_loss_ends=1", kLoadDuel + " life_loss_ends=0",
     "poke 18 01\nact NOOP"},
    {"noop_max", kLoadDuel + " noop_max=30", kLoadDuel + " noop_max=0", "look episode_frame"},
    {"autoreset", kLoadDuel + " max_episode_frames=2 autoreset=1",
     kLoadDuel + " max_episode_frames=2 autoreset=0", "observe episode_frame\nact NOOP*2\nact NOOP"},
    {"action_set", kLoadDuel + " action_set=full", kLoadDuel + " action_set=minimal", "act UP"},
    {"reward_min", kLoadDuel + " reward_min=1", kLoadDuel + " reward_min=0", "act NOOP"},
    {"reward_max", kLoadDuel + " reward_max=1", kLoadDuel + " reward_max=2",
     "observe reward_b\nact NOOP/RIGHT"},
    {"rules", kTetris + " rules=fixed", kTetris + " rules=ale-0.12",
     "poke 113 9999\nact NOOP\npoke 113 0000\nact NOOP"},
    {"color_averaging", "load beamfall seed=7 color_averaging=1", "load beamfall seed=7 color_averaging=0",
     "act FIRE*30\nlook screen"},
    {"sound", kLoadDuel + " sound=1", kLoadDuel + " sound=0", "act NOOP*2\nlook audio"},
    {"scheme", kLoadDuel + " scheme=2K", kLoadDuel + " scheme=4K", "act NOOP*9\nlook ram"},
    {"left", kLoadDuel + " left=paddles", kLoadDuel + " left=joystick", "act LEFT\nlook ram"},
    {"right", kLoadDuel + " right=paddles", kLoadDuel + " right=joystick", "act NOOP/LEFT\nlook ram"},
    {"format", kLoadDuel + " format=pal", kLoadDuel + " format=ntsc", "look screen"},
    {"ystart", "load beamfall seed=7 ystart=50", "load beamfall seed=7 ystart=34", "look screen"},
    {"height", kLoadDuel + " height=200", kLoadDuel + " height=210", "look screen"},
};

}  // namespace

const Cases& cases_without_game() { return kWithoutGame; }
const Cases& cases_with_duel() { return kWithDuel; }
const Cases& cases_of_settings() { return kSettings; }

}  // namespace racebeam::test
