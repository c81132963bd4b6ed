import { RefusedError, type Group, type Session } from "racebeam";
import { actWord, moveOf } from "../input/actions.js";
import { gamepad } from "../input/gamepad.js";
import { Keyboard } from "../input/keyboard.js";
import { Switches } from "../input/switches.js";
import { Touch } from "../input/touch.js";
import { Inspector } from "../inspect/inspector.js";
import { byId, tell } from "../page/elements.js";
import { reasonOf, type Server } from "../page/server.js";
import { titleOf } from "../page/titles.js";
import { Screen } from "../picture/screen.js";
import { soundRate } from "../picture/shape.js";
import type { Episode } from "../replay/log.js";
import { Speaker } from "../sound/speaker.js";
import { Figures } from "./figures.js";
import { GameChoice } from "./game_choice.js";
import { Pictures } from "./pictures.js";
import { Player, type Choice, type Game, type Motion, type Shown } from "./player.js";

const INSPECTED = ["grey84x84x1:delta", "tia:raw"]; // fields of the panels

/** The view in which a game is played. */
export class PlayView {
  /** Called with the episode that the user wants to see again. */
  onReplay: (episode: Episode) => void = () => {};
  /** Called with a sentence about the connection; an empty one if all is well. */
  onStatus: (sentence: string) => void = () => {};

  readonly #server: Server;
  readonly #stage = byId("stage", HTMLElement);
  readonly #start = byId("start", HTMLButtonElement);
  readonly #screen = new Screen(byId("screen", HTMLCanvasElement));
  readonly #speaker = new Speaker();
  readonly #inspector = new Inspector();
  readonly #figures = new Figures(byId("figures", HTMLElement));
  readonly #choice: GameChoice;
  readonly #keyboard: Keyboard;
  readonly #touch: Touch;
  readonly #switches: Switches;
  #player: Player | undefined;
  #session: Session | undefined;
  #lost = false;
  #active = false;
  #beginning: Promise<void> | undefined;
  #games: string[] = [];
  #minimal: number[] = [0]; // actions of the game

  constructor(server: Server) {
    this.#server = server;
    this.#choice = new GameChoice(new Pictures(server));
    const press = (time: number) => this.#player?.latency.press(time);
    this.#keyboard = new Keyboard(this.#stage, press);
    this.#touch = new Touch(byId("pad", HTMLElement), byId("fire", HTMLElement), press);
    this.#switches = new Switches(byId("reset", HTMLElement), byId("select", HTMLElement), () => this.#useSwitch());
    byId("touch", HTMLElement).hidden = !matchMedia("(pointer: coarse)").matches;
    this.#listen();
    this.#inspector.search.about = () => {
      const { name: title = "", md5 = "" } = this.#player?.game ?? {};
      return { title, md5, minimal: this.#minimal };
    };
  }

  /** Opens the session, and offers the games. */
  async #begin(): Promise<void> {
    await this.#open();
    const games = await this.#session!.games();
    this.#games = games;
    this.#choice.offer(games);
    const named = new URLSearchParams(location.search).get("game");
    const first = named && games.includes(named) ? named : games[0];
    if (first) {
      await this.#load({ game: first });
    }
    if (named && named !== first) {
      this.onStatus(`This server has no game "${named}". Choose one from the list.`);
    }
  }

  /** The view is shown or hidden. Hidden, the game pauses. A session is opened when it is first shown. */
  set active(active: boolean) {
    this.#active = active;
    if (active) {
      requestAnimationFrame((now) => this.#tick(now));
      this.#beginning ??= this.#begin().catch((error) => this.#lose(error));
    } else if (this.#player?.motion !== "paused") {
      this.#move("paused");
    }
  }

  /** Offers an image that the user has added, and loads it. */
  async add(md5: string): Promise<Game> {
    await this.#beginning;
    this.#games = [...new Set([...this.#games, md5])];
    this.#choice.offer(this.#games);
    return this.#choose({ game: md5 });
  }

  async #open(): Promise<void> {
    const { session, limits } = await this.#server.reopen(() => this.onStatus("The server does not answer. Trying again."));
    this.onStatus("");
    this.#lost = false;
    this.#session = session;
    this.#player = new Player(session, limits.max_states);
    this.#player.onShow = (shown) => this.#take(shown);
    this.#player.onFail = (error) => void this.#lose(error);
    void session.ended.then((error) => (session === this.#session ? this.#lose(error) : undefined));
    await this.#player.observe(this.#inspector.open ? INSPECTED : []);
  }

  /** The session has ended: opens another one, which plays the same acts to the same moment. */
  async #lose(error: unknown): Promise<void> {
    if (error instanceof RefusedError) {
      this.onStatus(`The server refuses: ${reasonOf(error)}.`);
      return;
    }
    if (this.#lost) {
      return;
    }
    this.#lost = true;
    this.onStatus("The connection is lost. Trying again.");
    const { game, acts = [] } = this.#player ?? {};
    try {
      if (game) {
        const { key, mode, difficulty, seed } = game;
        await this.#open();
        await this.#load({ game: key, mode, difficulty, seed }, acts);
      } else {
        await this.#begin();
      }
    } catch (again) {
      this.#lost = false;
      void this.#lose(again);
    }
  }

  async #load(choice: Choice, acts: readonly string[] = []): Promise<Game> {
    const player = this.#player!;
    this.#move("paused");
    const game = await player.load(choice, acts);
    this.onStatus("");
    await this.#server.claim(this.#session!, "player");
    const colours = await this.#session!.palette();
    this.#screen.become(colours, game.format, game.height);
    this.#speaker.rate = soundRate(game.format);
    this.#inspector.begin(colours, await this.#session!.names());
    const described = await this.#session!.game(game.key).catch((): Group => ({})); // an image without rules has no description
    this.#minimal = String(described.minimal ?? "0").split(",").map(Number);
    this.#choice.show(game, described, await this.#session!.difficulties());
    this.#screen.canvas.setAttribute("aria-label", `Screen of ${titleOf(game.key)}`);
    const last = await this.#session!.look("screen");
    this.#screen.draw(last.screen);
    this.#curtain(acts.length ? "Continue" : `Play ${titleOf(game.key)}`);
    return game;
  }

  /** The user has chosen a game or a setting: the new game begins at once if the one before was being played. */
  async #choose(choice: Choice): Promise<Game> {
    const playing = this.#player?.motion === "playing" && choice.game === this.#player.game?.key;
    const game = await this.#load(choice);
    this.#stage.scrollIntoView({ block: "nearest" });
    if (playing) {
      this.#go();
    } else {
      this.#start.focus({ preventScroll: true });
    }
    return game;
  }

  #listen(): void {
    const click = (id: string, action: () => void) => byId(id, HTMLButtonElement).addEventListener("click", action);
    this.#choice.onChoose = (choice) => void this.#choose(choice).catch((error) => this.#lose(error));
    this.#choice.onMoveSwitch = (bit) => this.#moveSwitch(bit);
    this.#start.onclick = () => this.#go();
    click("pause", () => (this.#player?.motion === "playing" ? this.#move("paused") : this.#go()));
    click("back", () => this.#single(-1));
    click("step", () => this.#single(1));
    click("new", () => void this.#again());
    click("mute", () => this.#mute());
    click("full", () => void this.#fill());
    click("inspect", () => void this.#inspect());
    click("replay-this", () => this.#replayThis());
    byId("picture", HTMLSelectElement).onchange = ({ target }) => {
      this.#stage.classList.remove("soft", "tube");
      this.#stage.classList.add((target as HTMLSelectElement).value);
    };
    const rewind = byId("rewind", HTMLButtonElement);
    rewind.onpointerdown = () => this.#move("rewinding");
    rewind.onpointerup = rewind.onpointerleave = () => this.#player?.motion === "rewinding" && this.#move("paused");
    rewind.onclick = ({ detail }) => detail === 0 && this.#player?.goTo(this.#player.now - 60); // by a key: a second
    this.#stage.addEventListener("keydown", (event) => this.#key(event));
    this.#stage.addEventListener("keyup", ({ code }) => code === "Backspace" && this.#move("playing"));
    this.#screen.canvas.addEventListener("pointerdown", () => this.#stage.focus());
  }

  #key(event: KeyboardEvent): void {
    const actions: Record<string, () => void> = {
      KeyP: () => byId("pause", HTMLButtonElement).click(),
      Period: () => this.#single(1),
      Comma: () => this.#single(-1),
      KeyN: () => void this.#again(),
      KeyM: () => this.#mute(),
      KeyF: () => void this.#fill(),
      KeyI: () => void this.#inspect(),
      KeyR: () => this.#useSwitch(),
      KeyE: () => this.#useSwitch(),
      KeyT: () => this.#showFigures(),
      Digit1: () => byId("left-switch", HTMLButtonElement).click(),
      Digit2: () => byId("right-switch", HTMLButtonElement).click(),
      Backspace: () => this.#move("rewinding"),
    };
    const action = actions[event.code];
    if (action && !event.ctrlKey && !event.altKey && !event.metaKey && event.target === this.#stage) {
      event.preventDefault();
      if (!event.repeat || event.code === "Period" || event.code === "Comma") {
        action();
      }
    }
  }

  /** Begins or continues, since the user said so. */
  #go(): void {
    void this.#speaker.start();
    this.#stage.focus();
    if (this.#player?.over) {
      void this.#again();
    } else {
      this.#move("playing");
    }
    this.#stage.scrollIntoView({ block: "nearest" }); // the layout while playing is another one
  }

  /** A switch of the console is used: the game must run to notice it. */
  #useSwitch(): void {
    if (this.#player?.motion !== "playing") {
      this.#go();
    }
  }

  /** Moves a difficulty switch, for which a frame is played. After the end of an episode, another one begins. */
  #moveSwitch(bit: 1 | 2): void {
    const player = this.#player;
    if (player?.game && player.over) {
      const { key: game, mode } = player.game;
      void this.#choose({ game, mode, difficulty: player.difficulty ^ bit }).catch((error) => this.#lose(error));
    } else {
      player?.act(moveOf(bit, player.difficulty));
    }
  }

  #move(motion: Motion): void {
    const player = this.#player;
    if (player) {
      player.motion = motion;
      this.#stage.dataset.motion = motion;
      tell(byId("pause-text", HTMLElement), motion === "playing" ? "Pause" : "Play");
      if (motion === "playing") {
        void this.#speaker.start();
        this.#start.hidden = true;
      }
    }
  }

  /** What players A and B press. */
  #pressed(): [number, number] {
    return [this.#keyboard.pressed(0) | this.#touch.pressed() | this.#switches.pressed() | gamepad(0), this.#keyboard.pressed(1) | gamepad(1)];
  }

  /** Goes a frame onward, with what is pressed, or a frame back, and stops there. */
  #single(frames: 1 | -1): void {
    this.#move("paused");
    this.#start.hidden = true;
    if (frames > 0) {
      this.#player?.act(actWord(...this.#pressed()));
    } else {
      this.#player?.goTo(this.#player.now - 1);
    }
  }

  async #again(): Promise<void> {
    await this.#player?.reset().catch((error) => this.#lose(error));
    this.#move("playing");
    this.#stage.focus();
  }

  #mute(): void {
    this.#speaker.on = !this.#speaker.on;
    byId("mute", HTMLButtonElement).setAttribute("aria-pressed", String(!this.#speaker.on));
  }

  #showFigures(): void {
    const figures = byId("figures", HTMLElement);
    figures.hidden = !figures.hidden;
  }

  async #fill(): Promise<void> {
    await (document.fullscreenElement ? document.exitFullscreen() : this.#stage.requestFullscreen());
    this.#stage.focus();
  }

  async #inspect(): Promise<void> {
    this.#inspector.open = !this.#inspector.open;
    byId("play-columns", HTMLElement).classList.toggle("inspecting", this.#inspector.open);
    byId("inspect", HTMLButtonElement).setAttribute("aria-pressed", String(this.#inspector.open));
    this.#stage.scrollIntoView({ block: "nearest" });
    await this.#player?.observe(this.#inspector.open ? INSPECTED : []).catch((error) => this.#lose(error));
  }

  #replayThis(): void {
    const { game, acts = [] } = this.#player ?? {};
    if (game) {
      const { key, mode, difficulty, seed } = game;
      const settings = { seed: String(seed), mode: String(mode), difficulty: String(difficulty), sticky: "0", frame_skip: "1", action_set: "console" };
      this.onReplay({ title: `${titleOf(key)}, played here`, game: key, settings, acts: [...acts] });
    }
  }

  #curtain(text: string): void {
    tell(this.#start, text);
    this.#start.hidden = false;
  }

  /** A reply has come. */
  #take(shown: Shown): void {
    if (this.#player?.motion === "playing") {
      this.#speaker.play(shown.audio);
    }
    this.#inspector.add(shown);
  }

  /** The display draws: shows the newest reply, and sends what is due. */
  #tick(now: number): void {
    if (!this.#active) {
      return;
    }
    requestAnimationFrame((next) => this.#tick(next));
    const player = this.#player;
    if (!player) {
      return;
    }
    const shown = player.take(performance.now());
    if (shown) {
      this.#draw(shown);
    }
    player.tick(now, ...this.#pressed());
    this.#figures.tick(now, player, this.#speaker, shown !== undefined);
  }

  #draw(shown: Shown): void {
    this.#screen.draw(shown.screen);
    tell(byId("score", HTMLElement), String(shown.score));
    tell(byId("lives", HTMLElement), String(shown.lives));
    tell(byId("frame", HTMLElement), String(shown.moment));
    this.#choice.showSwitches(this.#player!.difficulty);
    this.#inspector.draw(shown);
    if (shown.over) {
      this.#move("paused");
      this.#curtain("Game over: play again");
    }
  }
}
