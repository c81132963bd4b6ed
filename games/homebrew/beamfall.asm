; BEAMFALL - a 4K game for the Atari 2600, written for racebeam. MIT License.
;
; Inside the picture tube of an old television the beam falls, again and again. It burns whatever it
; touches, so be where its gap is, or shoot a gap of your own into it. Glitches crawl along five lanes and
; drop bolts; sparks drift about and are worth collecting before the beam sweeps them away.
;
; Assemble in this folder: dasm beamfall.asm -f3 -obeamfall.bin
;
; This file: constants, RAM map, start, frame loop, vectors. The rest, in the order of a frame:
;   beamfall/prepare.asm   positions and pointers for the kernel                 vertical blank
;   beamfall/display.asm   score, the field kernel, footer                       picture
;   beamfall/collide.asm   what the collision registers mean                     overscan
;   beamfall/play.asm      ship, shot, glitches, bolt, spark                     overscan
;   beamfall/beam.asm      the beam and the waves                                overscan
;   beamfall/console.asm   switches, start and end of a game, random numbers     overscan
;   beamfall/sound.asm     effects and the hum of the beam                       overscan
;   beamfall/graphics.asm  shapes, colours, title
; and lib/ for what the games of this folder share.

        processor 6502
        include "vcs.inc"
        include "lib/page.inc"

; ==== Constants ======================================================================================
; Frame: 3 lines VSYNC + 37 VBLANK + 192 picture + 30 overscan = 262. The timer reaches 0 after
; (value - 1) * 64 cycles; the WSYNC that follows completes the last line of 76 cycles.
VBLANK_TIME     = 44            ; 2752 cycles of the 2812 in 37 lines
OVERSCAN_TIME   = 36            ; 2240 cycles of the 2280 in 30 lines

; Field: 80 rows of two lines, numbered 80 (top) to 1. Lane n is rows 16n+1..16n+16; the highest row of a
; lane is its rail, where the kernel moves player 1 to the glitch of that lane.
LANES           = 5
LANE_ROWS       = 16
FIELD_ROWS      = LANES * LANE_ROWS
HIDDEN          = $F0           ; a row that the kernel never reaches

; Horizontal positions are those that PlaceObject takes: pixel - 6 for players, pixel - 5 for the others.
RIGHT_EDGE      = 146           ; ship, glitches
SHIP_START_X    = 70
SHIP_START_ROW  = 4
SHIP_TOP_ROW    = 72            ; highest row of the ship's lowest line
SHIP_ROWS       = 8
SPARK_RIGHT     = 148

PHASE_OVER      = 0             ; also the attract mode; FIRE or RESET starts a game
PHASE_PLAY      = 1
PHASE_HIT       = 2             ; the ship burns for phaseTimer frames

LIVES           = 4             ; at the start, and the most one can have
LAST_WAVE       = 8             ; waves count 0..8, shown as 1..9
BEAMS_PER_WAVE  = 5
FULL_WAVE       = 2             ; from this wave on the lowest lane has its glitch too
HIT_TIME        = 64
OVER_TIME       = 60            ; frames before FIRE is heard again
SHIELD_TIME     = 100           ; frames in which a new ship cannot be hurt
SPARK_WAIT      = 50
LOWEST_SPARK    = 14

BEAM_ROWS       = 4
BEAM_START      = FIELD_ROWS + 12  ; above the top: a pause between two beams
BEAM_SPEED      = $68           ; rows a frame / 256; 16 more in every wave,
BEAM_SPEED_A    = $14           ; and this more with left difficulty A: 252 in the last wave
GAP_B           = 7             ; width of the gap in playfield cells of 4 pixels, in wave 0
GAP_A           = 5

GLITCH_DIR      = $80           ; bit of glitchState: crawls to the left
GLITCH_DEAD     = 64            ; frames from kill to return; bits 0-6 of glitchState count them down
GLITCH_BURST    = 48            ; above this count the burst is shown, below nothing

SHOT_SPEED      = 2             ; rows a frame
BOLT_SPEED_B    = $80           ; rows a frame / 256; 8 more in every wave, 255 at most
BOLT_SPEED_A    = $D8

; ==== RAM ============================================================================================
        seg.u ram
        org $80

; -- the state of a game (what an agent would read) --
phase           ds 1            ; $80  PHASE_xxx
lives           ds 1            ; $81  ships left, this one included; 0 when the game is over
score           ds 3            ; $82  BCD, most significant byte first
wave            ds 1            ; $85  0..LAST_WAVE
shipX           ds 1            ; $86
shipRow         ds 1            ; $87  row of its lowest line
shotX           ds 1            ; $88
shotRow         ds 1            ; $89  HIDDEN when there is none
boltX           ds 1            ; $8A
boltRow         ds 1            ; $8B  HIDDEN when there is none
sparkX          ds 1            ; $8C
sparkRow        ds 1            ; $8D  HIDDEN when there is none
beamRow         ds 1            ; $8E  lowest row of the beam
beamCells       ds 6            ; $8F  PF0 PF1 PF2 of the left half, PF0 PF1 PF2 of the right half
glitchX         ds LANES        ; $95  lowest lane first
glitchState     ds LANES        ; $9A  GLITCH_DIR and the count since its death, 0 = alive

; -- what moves it --
frame           ds 1            ; counts frames
random          ds 2            ; shift register, never 0
phaseTimer      ds 1
shield          ds 1
beamFrac        ds 1            ; fractions of rows and pixels, in 1/256
boltFrac        ds 1
glitchFrac      ds LANES
beamCount       ds 1            ; beams survived in this wave
sparkTimer      ds 1            ; frames until a spark appears
sparkStep       ds 1            ; 1 or $FF

; -- sound: one effect on each channel --
effect          ds 2            ; number in the tables of sound.asm
effectTime      ds 2            ; frames left; 0 = silent
effectPitch     ds 2            ; AUDF * 8

; -- the kernel --
glitchFine      ds LANES        ; HMP1 for every lane
glitchCoarse    ds LANES        ; rounds of the delay loop before RESP1
glitchShape     ds LANES        ; low byte of the shape, lane offset included
shipPtr         ds 2
shipColourPtr   ds 2
glitchPtr       ds 2
beamColour      ds BEAM_ROWS
sparkColour     ds 1
railColour      ds 1
laneColour      ds 1
nextCoarse      ds 1
lane            ds 1
laneEnd         ds 1            ; row of the next rail, 0 = end of the field
shipFine        ds 1            ; HMP0 and delay of the ship
shipCoarse      ds 1
temp            ds 1
temp2           ds 1
digits          ds 12           ; pointers to the six columns of the score line
        echo "BEAMFALL: RAM up to", ., "stack from $FF down"

; ==== Start ==========================================================================================
        seg rom
        org $F000

        include "beamfall/display.asm"  ; code that counts cycles comes first: it must not cross pages
        include "lib/place.asm"
        include "lib/score.asm"

Start   sei
        cld
        ldx #$FF
        txs
        inx
        txa
.clear  sta 0,x                 ; all TIA registers and all RAM
        inx
        bne .clear
        lda #$5A
        sta random
        jsr ShowAttract

; ==== Frame loop =====================================================================================
Frame   lda #2
        sta WSYNC               ; completes the overscan
        sta VSYNC
        sta WSYNC
        sta WSYNC
        lda #VBLANK_TIME
        sta WSYNC
        sta TIM64T
        lda #0
        sta VSYNC

        inc frame
        jsr PrepareDisplay
.vblank lda INTIM
        bne .vblank
        sta WSYNC
        jsr Display             ; returns at the start of the first overscan line

        lda #OVERSCAN_TIME
        sta TIM64T
        jsr Collide
        jsr Play
        jsr ReadConsole
        jsr Sound
.over   lda INTIM
        bne .over
        jmp Frame

        include "beamfall/prepare.asm"
        include "beamfall/collide.asm"
        include "beamfall/play.asm"
        include "beamfall/beam.asm"
        include "beamfall/console.asm"
        include "beamfall/sound.asm"
        include "lib/points.asm"
        include "lib/random.asm"
        include "lib/effects.asm"
        include "beamfall/graphics.asm"

; ==== Vectors ========================================================================================
        org $FFFA
        .word Start
        .word Start
        .word Start
