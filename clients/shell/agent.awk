#!/usr/bin/env -S mawk -W interactive -f
# Plays an episode of Beamfall over named pipes, in a dozen lines of awk: agent.awk <PREFIX_out >PREFIX_in. Standard input has the
# replies, and standard output takes the requests; the score goes to standard error. mawk, Debian's awk, reads whole blocks
# unless it is interactive; with another: gawk -f agent.awk.
function ask(request) { print request; fflush() }
function value(key) { return match($0 " ", " " key "=[^ ]* ") ? substr($0, RSTART + length(key) + 2, RLENGTH - length(key) - 3) : "" }
BEGIN { ask("load beamfall seed=1 sticky=0 frame_skip=4") }
!/^ok/ { print > "/dev/stderr"; exit 1 }
NR == 1 { ask("observe reward terminated truncated"); next }
NR > 2 { score += value("reward") }
value("terminated") + value("truncated") { print "score " score > "/dev/stderr"; exit }
{ ask("act RIGHTFIRE*4 LEFTFIRE*4") }
