// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.

import { keyed, list } from "./words.js";

/** The commands whose methods only send their words. `request` is a session's. */
export class Commands {
  async hello(token) {
    return (await this.request("hello", keyed("token", token)))[0];
  }

  async games(which) {
    return list((await this.request("games", which ?? []))[0].games);
  }

  async settings() {
    return (await this.request("settings"))[0];
  }

  async set(settings = {}) {
    return (await this.request("set", settings))[0];
  }

  async modes() {
    return list((await this.request("modes"))[0].modes).map(Number);
  }

  async difficulties() {
    return list((await this.request("difficulties"))[0].difficulties).map(Number);
  }

  async observe(...fields) {
    return list((await this.request("observe", ...fields))[0].fields);
  }

  async look(...fields) {
    return (await this.request("look", ...fields))[0];
  }

  async act(...actions) {
    return (await this.request("act", ...actions))[0];
  }

  async reset(seed) {
    return (await this.request("reset", keyed("seed", seed)))[0];
  }

  async save(name, settings = {}) {
    await this.request("save", name, settings);
  }

  async restore(name, machine) {
    return (await this.request("restore", name, keyed("machine", machine)))[0];
  }

  async drop(...names) {
    await this.request("drop", ...names);
  }

  async states() {
    return list((await this.request("states"))[0].states);
  }

  async open(count, settings = {}) {
    return (await this.request("open", count, settings)).slice(1);
  }

  async step(...actions) {
    return (await this.request("step", ...actions)).slice(1);
  }

  async restart(mask, seed) {
    return (await this.request("restart", mask ?? [], keyed("seed", seed))).slice(1);
  }

  async closeMachines() {
    await this.request("close");
  }

  async record(kinds, name, machine) {
    return (await this.request("record", kinds, name, keyed("machine", machine)))[0];
  }

  async log(name, settings = {}) {
    return (await this.request("log", name, settings))[0];
  }

  async shot(name, machine) {
    return (await this.request("shot", name ?? [], keyed("machine", machine)))[0];
  }

  async share(name, watchers) {
    return (await this.request("share", name, keyed("watchers", watchers)))[0];
  }

  async unshare() {
    await this.request("unshare");
  }

  async shared() {
    return (await this.request("shared")).slice(1);
  }

  async watch(name, settings = {}, ...fields) {
    return (await this.request("watch", name, settings, ...fields))[0];
  }

  async stats() {
    return (await this.request("stats"))[0];
  }

  async quit() {
    await this.request("quit");
  }
}
