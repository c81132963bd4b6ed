"""The tables and the methods of the client in Lua."""

from javascript_client import Signature, entries_of, generated

FOLDER = "clients/lua/racebeam"
HEAD = "-- Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.\n\n"
KINDS = {"first": "first", "groups": "rest", "nothing": "nothing", "list": "list", "ints": "ints"}


def parameters(signature):
    yield from (argument.name for argument in signature.words)
    if signature.setting:
        yield signature.setting.name
    if signature.settings:
        yield "settings"
    if signature.repeated:
        yield "..."


def request(command, signature):
    yield f'"{command.name}"'
    has_settings = False
    for argument in command.arguments:
        if argument.key and signature.setting:
            yield f'keyed("{argument.key}", {argument.name})'
        elif argument.key and not has_settings:
            has_settings = True
            yield 'settings or ""'
        elif argument.is_repeated:
            yield "..."
        elif not argument.key:
            yield f'{argument.name} or ""' if argument.optional else argument.name


def method(command):
    kind, _, key = command.returns.partition(" ")
    signature = Signature(command)
    words = ", ".join(["self", *([f'"{key}"'] if key else []), *request(command, signature)])
    about = "".join(f"\n-- {argument.name}: {argument.about}." for argument in command.arguments if argument.about)
    return (
        f"-- {command.summary[0].upper()}{command.summary[1:]}.{about}\n"
        f"function methods:{command.method}({', '.join(parameters(signature))})\n"
        f"  {'' if kind == 'nothing' else 'return '}{KINDS[kind]}({words})\nend\n"
    )


HELPERS = """local methods = {}

-- The setting of a method that takes one: its value, or a table that has it.
local function keyed(key, value)
  return type(value) == "table" and value or value ~= nil and { [key] = value } or ""
end

local function first(session, ...)
  return session:request(...)[1]
end

local function rest(session, ...)
  local groups = session:request(...)
  table.remove(groups, 1)
  return groups
end

local function nothing(session, ...)
  session:request(...)
end

local function list(session, key, ...)
  local found = {}
  for part in tostring(first(session, ...)[key]):gmatch("[^,]+") do
    found[#found + 1] = part
  end
  return found
end

local function ints(session, key, ...)
  local found = list(session, key, ...)
  for at, text in ipairs(found) do
    found[at] = tonumber(text)
  end
  return found
end

"""


def commands(protocol):
    methods = "\n".join(method(command) for command in generated(protocol))
    return (
        f"{HEAD}-- The commands whose methods only send their words. `request` is a session's.\n\n"
        f"{HELPERS}{methods}\nreturn methods\n"
    )


def flags(protocol):
    """The keys of replies that are true or false: fields, settings, and those of commands."""
    rows = [row.name for row in (*protocol.fields, *protocol.settings) if row.type == "flag"]
    rows += [row.name for row in protocol.settings if {"0", "1"} == set(row.old_values)]  # that replies still have
    replies = [reply for command in protocol.commands for reply in (command.reply, command.groups)]
    keys = [key.removesuffix("?") for reply in replies for key, kind in reply.items() if kind == "flag"]
    return list(dict.fromkeys([*rows, *keys]))


def table(pairs):
    return "{\n" + "".join(f"    {key} = {value},\n" for key, value in pairs) + "  }"


def fields(protocol):
    usual, sizes, pixels = (table(pairs) for pairs in entries_of(protocol))
    return (
        f"{HEAD}return {{\n"
        f"  -- The encodings of fields of bytes where a request does not name one.\n  usual = {usual},\n"
        f"  -- The sizes in bytes of fields whose size never changes.\n  sizes = {sizes},\n"
        f"  -- Bytes per pixel of fields with the size of the screen.\n  pixels = {pixels},\n"
        f"  -- Values that become true or false: 0 would be true in Lua.\n  flags = "
        f"{table((name, 'true') for name in flags(protocol))},\n}}\n"
    )


def files(protocol, read):
    return {f"{FOLDER}/commands.lua": commands(protocol), f"{FOLDER}/field_table.lua": fields(protocol)}
