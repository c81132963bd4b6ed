import { byId, markCurrent, tell } from "./page/elements.js";
import { Server } from "./page/server.js";
import { PlayView } from "./play/play_view.js";
import { ReplayView } from "./replay/replay_view.js";
import { WatchView } from "./watch/watch_view.js";

const VIEWS = ["play", "watch", "replay"] as const;
type View = typeof VIEWS[number];

declare const WITHOUT_SERVER: boolean; // build.mjs --static

let shown: View | undefined;

const server = new Server();
const play = new PlayView(server);
const replay = new ReplayView(server);
const watch = new WatchView(server);

play.onReplay = (episode) => {
  location.hash = "#replay";
  void replay.open(episode);
};

play.onStatus = watch.onStatus = (sentence) => {
  const status = byId("status", HTMLElement);
  tell(status, sentence);
  status.classList.toggle("lost", sentence !== "");
};

/** Shows the view that the address names after #. Other names there, such as that of the link that skips, change no view. */
function navigate(): void {
  const named = /^#(\w+)/.exec(location.hash)?.[1];
  show(VIEWS.find((each) => each === named) ?? shown ?? "play");
}

function show(view: View): void {
  if (view === shown) {
    return;
  }
  shown = view;
  for (const each of VIEWS) {
    byId(`${each}-view`, HTMLElement).hidden = each !== view;
    markCurrent(document.querySelector<HTMLElement>(`nav a[href="#${each}"]`)!, each === view, "page");
  }
  play.active = view === "play";
  replay.active = view === "replay";
  watch.active = view === "watch";
}

if (WITHOUT_SERVER) {
  const { OwnImages } = await import("./play/own_images.js");
  new OwnImages((md5) => play.add(md5));
  // Other clients share nothing with this page.
  for (const link of document.querySelectorAll<HTMLElement>("[data-view=watch]")) link.hidden = true;
}
addEventListener("hashchange", navigate);
navigate();
await replay.follow(location.hash);
