# Completion of requests for bash at a terminal, after racebeam.bash:
#
#   source racebeam.bash; source completion.bash
#   racebeam_ask load beamfall life_loss=<Tab>
#
# Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.

# What may follow each command. `=` at the end: a value follows.
declare -rA _racebeam_follows=(
  [hello]='token='
  [help]='settings presets fields encodings errors states hello help games load set modes difficulties actions names observe look act reset peek poke save restore drop export import branch open step restart close record log shot share unshare shared watch stats quit preset seed system_seed frame_skip sticky mode difficulty max_episode_frames life_loss noop_max autoreset action_set reward_min reward_max rules color_averaging sound scheme left right format ystart height paper2013 dqn2015 machado2018 gym-v5 reward reward_b raw_reward raw_reward_b terminated truncated game_over lives frame episode_frame acts frames ram tia state_hash screen rgb grey greyWxHxN rgbWxHxN palette audio audio_all hex rle delta base64 zlib raw bad-line line-too-long half-line unknown-command bad-arguments bad-value bad-action unknown-game bad-image no-game no-machines no-state bad-state recording no-log limit unauthorized busy idle stopping internal'
  [games]='all'
  [load]='inline image= as= preset=paper2013 preset=dqn2015 preset=machado2018 preset=gym-v5 seed= system_seed= frame_skip= sticky= mode= difficulty= max_episode_frames= life_loss=ignored life_loss=reported life_loss=end life_loss=restart noop_max= autoreset=disabled autoreset=next-step autoreset=same-step action_set=full action_set=legal action_set=minimal action_set=console reward_min= reward_max= rules=ale-0.12 rules=fixed color_averaging=0 color_averaging=1 sound=0 sound=1 scheme= left=joystick left=paddles left=keyboard left=driving left=booster left=genesis left=light_gun left=trackball left=atari_mouse left=amiga_mouse left=savekey left=none right=joystick right=paddles right=keyboard right=driving right=booster right=genesis right=light_gun right=trackball right=atari_mouse right=amiga_mouse right=savekey right=none format=auto format=ntsc format=pal format=pal60 format=secam ystart= height='
  [settings]=''
  [set]='mode= difficulty='
  [modes]=''
  [difficulties]=''
  [actions]=''
  [names]=''
  [observe]='FIELD none'
  [look]='FIELD'
  [act]='NOOP FIRE UP RIGHT LEFT DOWN UPRIGHT UPLEFT DOWNRIGHT DOWNLEFT UPFIRE RIGHTFIRE LEFTFIRE DOWNFIRE UPRIGHTFIRE UPLEFTFIRE DOWNRIGHTFIRE DOWNLEFTFIRE RESET SELECT LEFT_A LEFT_B RIGHT_A RIGHT_B COLOR BW'
  [reset]='seed=random'
  [peek]=''
  [poke]=''
  [save]='generator=1 machine='
  [restore]='machine='
  [drop]='all'
  [states]=''
  [export]='episode=1'
  [import]=''
  [branch]='keep='
  [open]='autoreset=next-step autoreset=disabled autoreset=same-step steps=acts steps=frames start=fire-noops start=noops-fire start=baselines start=noops life_loss=ignored life_loss=reported life_loss=end life_loss=restart stack=zeros stack=repeats pool=1 pool=0'
  [step]='NOOP FIRE UP RIGHT LEFT DOWN UPRIGHT UPLEFT DOWNRIGHT DOWNLEFT UPFIRE RIGHTFIRE LEFTFIRE DOWNFIRE UPRIGHTFIRE UPLEFTFIRE DOWNRIGHTFIRE DOWNLEFTFIRE RESET SELECT LEFT_A LEFT_B RIGHT_A RIGHT_B COLOR BW'
  [restart]='seed=random'
  [close]=''
  [record]='png gif y4m wav webm mp4 machine='
  [log]='inline agent= version= agent_seed= trial= training_frames= phrase= role=learner role=planner role=baseline link= machine='
  [shot]='machine='
  [share]='watchers='
  [unshare]=''
  [shared]=''
  [watch]='since= FIELD'
  [stats]=''
  [quit]=''
)
readonly _racebeam_field_words='reward reward_b raw_reward raw_reward_b terminated truncated game_over lives frame episode_frame acts frames ram tia state_hash screen rgb grey greyWxHxN rgbWxHxN palette audio audio_all' _racebeam_encoding_words='hex rle delta base64 zlib raw'

_racebeam_complete() {
  local typed=${COMP_LINE:0:COMP_POINT} word words one before
  word=${typed##* }
  read -ra words <<<"${typed% *}"
  COMPREPLY=()
  if ((${#words[@]} == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "${!_racebeam_follows[*]}" -- "$word")
  elif [[ $word == *:* ]]; then
    mapfile -t COMPREPLY < <(compgen -P "${word%:*}:" -W "$_racebeam_encoding_words" -- "${word##*:}")
  else
    for one in ${_racebeam_follows[${words[1]}]-}; do
      [[ $one == FIELD ]] && one=$_racebeam_field_words
      mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W "$one" -- "$word")
    done
  fi
  [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *= ]] && compopt -o nospace 2>/dev/null
  before=${word%"${word##*["$COMP_WORDBREAKS"]}"}  # bash replaces what follows the last sign that breaks words
  COMPREPLY=("${COMPREPLY[@]#"$before"}")
}
complete -F _racebeam_complete racebeam_ask racebeam_send
