#include "protocol/line/commands/command_table.hpp"

#include <array>

namespace racebeam {

// command_session.cpp
void run_hello(Session&, Words);
void run_help(Session&, Words);
void run_stats(Session&, Words);
void run_quit(Session&, Words);

// command_load.cpp
void run_games(Session&, Words);
void run_load(Session&, Words);
void run_settings(Session&, Words);
void run_set(Session&, Words);
void run_modes(Session&, Words);
void run_difficulties(Session&, Words);
void run_actions(Session&, Words);
void run_names(Session&, Words);

// command_play.cpp
void run_observe(Session&, Words);
void run_look(Session&, Words);
void run_act(Session&, Words);
void run_reset(Session&, Words);
void run_peek(Session&, Words);
void run_poke(Session&, Words);

// command_state.cpp
void run_save(Session&, Words);
void run_restore(Session&, Words);
void run_drop(Session&, Words);
void run_states(Session&, Words);
void run_export(Session&, Words);
void run_import(Session&, Words);
void run_branch(Session&, Words);

// command_machines.cpp
void run_open(Session&, Words);
void run_step(Session&, Words);
void run_restart(Session&, Words);
void run_close(Session&, Words);

// command_record.cpp
void run_record(Session&, Words);

// command_share.cpp
void run_share(Session&, Words);
void run_unshare(Session&, Words);
void run_shared(Session&, Words);
void run_watch(Session&, Words);

namespace {

// name, arguments, summary, hint, example, least and most arguments, what it needs, handler
constexpr std::array kCommands = {
    Command{"hello", "[token=TOKEN]", "the server's name, version and limits", "", "hello", 0, 1,
            Needs::kNothing, run_hello},
    Command{"help", "[COMMAND|KEY|settings|presets|fields|encodings|errors|states]", "explain", "",
            "help act", 0, 1, Needs::kNothing, run_help},
    Command{"games", "[all|GAME]", "list the games whose image is here, or all known games; or describe one",
            "", "games beamfall", 0, 1, Needs::kAdmission, run_games},
    Command{"load", "GAME|MD5|inline [image=BASE64] [as=GAME] [KEY=VALUE...]",
            "power on with an image and begin an episode",
            "help settings has the keys, help presets the presets, games the games",
            "load beamfall seed=7 frame_skip=4", 1, kAnyNumber, Needs::kAdmission, run_load},
    Command{"settings", "", "the settings in effect", "", "", 0, 0, Needs::kGame, run_settings},
    Command{"set", "[mode=N] [difficulty=N]",
            "change the mode, from the next reset on, or the difficulty, at once",
            "modes and difficulties have the numbers", "set difficulty=1", 1, 2, Needs::kGame, run_set},
    Command{"modes", "", "the game's modes", "", "", 0, 0, Needs::kGame, run_modes},
    Command{"difficulties", "", "the game's difficulties", "", "", 0, 0, Needs::kGame, run_difficulties},
    Command{"actions", "", "list the actions that act accepts, and the game's legal and minimal ones", "", "",
            0, 0, Needs::kGame, run_actions},
    Command{"names", "", "names for bytes of the fields ram and tia", "", "", 0, 0, Needs::kGame, run_names},
    Command{"observe", "[FIELD[:ENCODING]...|none]", "select the fields of replies",
            "help fields has the fields and encodings", "observe reward ends screen:rle", 0, kAnyNumber,
            Needs::kAdmission, run_observe},
    Command{"look", "[FIELD[:ENCODING]...]", "show these fields once; without fields, the selected ones",
            "help fields has the fields and encodings", "look lives screen:base64", 0, kAnyNumber,
            Needs::kGame, run_look},
    Command{"act", "A[@STRENGTH][/B[@STRENGTH]][*TIMES]...", "play actions until the episode ends",
            "actions has the actions; B is player B's, STRENGTH how far a paddle is turned, 0 to 1",
            "act FIRE RIGHT*10 3", 1, kAnyNumber, Needs::kGame, run_act},
    Command{"reset", "[seed=N]", "begin an episode; with a seed, power on anew with it", "", "reset seed=8",
            0, 1, Needs::kGame, run_reset},
    Command{"peek", "INDEX [COUNT]", "bytes of RAM, 0 to 127", "", "peek 3 4", 1, 2, Needs::kGame, run_peek},
    Command{"poke", "INDEX HEX", "write bytes of RAM", "", "poke 3 FF00", 2, 2, Needs::kGame, run_poke},
    Command{"save", "NAME [random=1] [machine=N]", "save the state; random=1: with the random generator",
            "machine= takes one of open, 0 the first", "save start", 1, 3, Needs::kGame, run_save},
    Command{"restore", "NAME [machine=N]", "restore a saved state", "machine= takes one of open, 0 the first",
            "restore start", 1, 2, Needs::kGame, run_restore},
    Command{"drop", "NAME...|all", "delete states", "", "drop start", 1, kAnyNumber, Needs::kGame, run_drop},
    Command{"states", "", "the names of the states", "", "", 0, 0, Needs::kGame, run_states},
    Command{"export", "NAME [whole=1]", "show a state as base64, for later or for another process",
            "whole=1: with the score, the progress of the episode and the stack of screens", "export start",
            1, 2, Needs::kGame, run_export},
    Command{"import", "NAME BASE64", "save an exported state under this name", "", "", 2, 2, Needs::kGame,
            run_import},
    Command{"branch", "NAME [keep=PREFIX] ACTION[,ACTION...]...",
            "play lists of actions from a state; the session itself does not change",
            "actions are written as for act; keep= saves where the lists end, as PREFIX0, PREFIX1, ...",
            "branch start FIRE*50 UP,RIGHT*9", 2, kAnyNumber, Needs::kGame, run_branch},
    Command{"open",
            "N [autoreset=next-step|same-step|disabled] [steps=acts|frames] "
            "[start=fire-noops|noops-fire|baselines|noops] [lives=ignored|told|end|restart] "
            "[stack=zeros|repeats] [pool=0|1]",
            "create N machines with the loaded game and settings; their seeds count up",
            "start, lives, stack and pool go with steps=frames", "open 4 autoreset=same-step", 1, 7,
            Needs::kGame, run_open},
    Command{"step", "ACTION...", "play one act on each machine: an action each, or one for all",
            "written as for act", "step FIRE UP RIGHT 4", 1, kAnyNumber, Needs::kMachines, run_step},
    Command{"restart", "[MASK] [seed=N]",
            "reset the machines that have a 1 in MASK, such as 0110, or all; seeds count up",
            "with a seed, the machines are powered on anew", "restart 0110", 0, 2, Needs::kMachines,
            run_restart},
    Command{"close", "", "close the machines", "", "", 0, 0, Needs::kMachines, run_close},
    Command{"record", "png|gif|y4m|wav|webm|mp4[,...] NAME [machine=N] | stop",
            "record frames, sound or both into the server's folder",
            "machine= takes one of open, 0 the first", "record gif first", 1, 3, Needs::kGame, run_record},
    Command{"share", "NAME [watchers=N]", "let other sessions watch the game under this name",
            "names are one word; unshare ends it", "share room", 1, 2, Needs::kGame, run_share},
    Command{"unshare", "", "end what share has begun", "", "", 0, 0, Needs::kAdmission, run_unshare},
    Command{"shared", "", "list the shared sessions", "", "", 0, 0, Needs::kAdmission, run_shared},
    Command{"watch", "NAME [since=FRAME] [FIELD[:ENCODING]...]", "show a shared session as it was lately",
            "the fields are screen, ram and palette; a picture comes only if its frame is not FRAME",
            "watch room since=7 screen:delta", 1, 5, Needs::kAdmission, run_watch},
    Command{"stats", "", "counters of this session", "", "", 0, 0, Needs::kAdmission, run_stats},
    Command{"quit", "", "end the session", "", "", 0, 0, Needs::kNothing, run_quit},
};

constexpr std::array kAliases = {Alias{"?", "help"}, Alias{"exit", "quit"}};

constexpr CommandTable kTable = {kCommands, kAliases};

}  // namespace

const CommandTable& command_table() { return kTable; }
std::span<const Command> commands() { return kCommands; }
std::span<const Alias> aliases() { return kAliases; }
const Command& find_command(std::string_view name) { return kTable.find(name); }

}  // namespace racebeam
