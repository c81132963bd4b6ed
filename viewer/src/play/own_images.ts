import { byId, tell } from "../page/elements.js";
import { addImage } from "../page/emulator.js";
import { sentenceOf } from "../page/server.js";
import { nameOwn } from "../page/titles.js";
import type { Game } from "./player.js";

const GAME_FILE = ".toml";
const REMARKS: Readonly<Record<string, string>> = {
  other: "The rule was written for another image of this game: the score may be wrong.",
  doubtful: "It may not run: nothing in it says which cartridge it is of.",
};
const WITHOUT_RULE = "No rule is known for it, so the score stays 0. Inspect finds the score in memory.";

function stem(file: File): string {
  return file.name.replace(/\..*$/, "").toLowerCase();
}

/** Images from the user's disk, chosen or dropped onto the view. They go to the emulator in the page, and nowhere else. */
export class OwnImages {
  readonly #play: (md5: string) => Promise<Game>;
  readonly #box = byId("own-images", HTMLElement);
  readonly #problem = byId("image-problem", HTMLElement);
  readonly #remark = byId("image-remark", HTMLElement);

  /** play: loads the image with this MD5. */
  constructor(play: (md5: string) => Promise<Game>) {
    this.#play = play;
    this.#box.hidden = false;
    const input = byId("image-files", HTMLInputElement);
    input.onchange = async () => {
      await this.#add([...(input.files ?? [])]);
      input.value = "";
    };
    const view = byId("play-view", HTMLElement);
    for (const type of ["dragenter", "dragover", "dragleave", "drop"] as const) {
      view.addEventListener(type, (event) => {
        event.preventDefault();
        this.#box.classList.toggle("over", type === "dragenter" || type === "dragover");
      });
    }
    view.addEventListener("drop", ({ dataTransfer }) => void this.#add([...(dataTransfer?.files ?? [])]));
  }

  /** Adds images, each with the game file of its name, or with the only one if there is one image. */
  async #add(files: readonly File[]): Promise<void> {
    const isGame = (file: File) => file.name.toLowerCase().endsWith(GAME_FILE);
    const [games, images] = [files.filter(isGame), files.filter((file) => !isGame(file))];
    tell(this.#remark, "");
    tell(this.#problem, games.length && !images.length ? "A game file belongs to an image: choose both at once." : "");
    try {
      for (const image of images) {
        const gameFile = games.find((game) => stem(game) === stem(image)) ?? (images.length === 1 ? games[0] : undefined);
        const { md5, game } = await addImage(image, gameFile ? { gameFile } : {});
        nameOwn(md5, game);
        const loaded = await this.#play(md5);
        tell(this.#remark, REMARKS[loaded.image] ?? (loaded.rule ? "" : WITHOUT_RULE));
      }
    } catch (error) {
      tell(this.#problem, `${sentenceOf(error)}.`);
    }
  }
}
