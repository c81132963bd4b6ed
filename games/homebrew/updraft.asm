; UPDRAFT - an 8K game for the Atari 2600 with a paddle and F8 bank switching, written for racebeam. MIT License.
;
; A balloon over the hills at sunset; the paddle is its burner. Birds come from the right, darts are aimed
; at you, stars are worth catching, and the button blows a puff of hot air that turns a bird away. Keep off
; the hills and out of the thunderclouds.
;
; Assemble in this folder: dasm updraft.asm -f3 -oupdraft.bin
;
; Two banks of 4K share the addresses $1000-$1FFF of the cartridge; touching $1FF8 shows bank 0, $1FF9 bank 1.
; To tell them apart, bank 0 is assembled at $D000 and bank 1 at $F000: the CPU has 13 address lines and sees
; no difference.
;   bank 0   frame loop and picture    updraft/display.asm, prepare.asm, graphics.asm
;   bank 1   the rules of the game     updraft/rules.asm, collide.asm, console.asm, sound.asm
; and lib/ for what the games of this folder share.

        processor 6502
        include "vcs.inc"
        include "lib/page.inc"

; ==== Constants ======================================================================================
; Frame: 3 lines VSYNC + 37 VBLANK + 192 picture + 30 overscan = 262. The timer reaches 0 after
; (value - 1) * 64 cycles; the WSYNC that follows completes the last line of 76 cycles.
RELEASE_TIME    = 37            ; 2304 cycles: to line 31 of the VBLANK
RELEASE_LINES   = 6             ; from there to the picture
OVERSCAN_TIME   = 36            ; 2240 cycles of the 2280 in 30 lines

SHOW_BANK_0     = $1FF8
SHOW_BANK_1     = $1FF9
STUBS           = $FD0          ; code that is the same in both banks

; Field: 80 rows of two lines, numbered 80 (top) to 1. Positions are those that PlaceObject takes:
; pixel - 6 for players, pixel - 5 for the others.
FIELD_ROWS      = 80
HIDDEN          = $F0           ; a row that the kernel never reaches
BALLOON_X       = 24
BALLOON_ROWS    = 12
BALLOON_START   = 34
BALLOON_TOP     = 69            ; highest row of its lowest line
BIRD_TOP        = 70            ; highest row of its lowest line
RIGHT_EDGE      = 146
LOWEST_FLIGHT   = 18            ; birds and stars keep above the hills

PHASE_OVER      = 0             ; also the attract mode; the button or RESET starts a game
PHASE_PLAY      = 1
PHASE_HIT       = 2             ; the balloon burns for phaseTimer frames

LIVES           = 4             ; at the start, and the most one can have
LAST_WAVE       = 8             ; waves count 0..8, shown as 1..9
BIRDS_PER_WAVE  = 8
HIT_TIME        = 64
OVER_TIME       = 60            ; frames before the button is heard again
SHIELD_TIME     = 90            ; frames in which a new balloon cannot be hurt

BIRD_SPEED      = $20           ; 1 pixel and this / 256 a frame; 24 / 256 more in every wave
DART_SPEED      = 2             ; pixels a frame
PUFF_SPEED      = 3
DART_WAIT       = 200
STAR_WAIT       = 70

; ==== RAM ============================================================================================
        seg.u ram
        org $80

; -- the state of a game (what an agent would read) --
phase           ds 1            ; $80  PHASE_xxx
lives           ds 1            ; $81  balloons left, this one included; 0 when the game is over
score           ds 3            ; $82  BCD, most significant byte first
wave            ds 1            ; $85  0..LAST_WAVE
balloonRow      ds 1            ; $86  row of its lowest line
birdX           ds 1            ; $87
birdRow         ds 1            ; $88
dartX           ds 1            ; $89
dartRow         ds 1            ; $8A  HIDDEN when there is none
starX           ds 1            ; $8B
starRow         ds 1            ; $8C  HIDDEN when there is none
puffX           ds 1            ; $8D
puffRow         ds 1            ; $8E  HIDDEN when there is none

; -- what moves it --
paddleRow       ds 1            ; the row that the beam had reached when the capacitor was charged
frame           ds 1            ; counts frames
random          ds 2            ; shift register, never 0
phaseTimer      ds 1
shield          ds 1
birdFrac        ds 1            ; fractions of pixels, in 1/256
birdCount       ds 1            ; birds passed or turned away in this wave
starTimer       ds 1            ; frames until a star, a dart appear
dartTimer       ds 1

; -- sound: one effect on each channel --
effect          ds 2            ; number in the tables of sound.asm
effectTime      ds 2            ; frames left; 0 = silent
effectPitch     ds 2            ; AUDF * 8

; -- the kernel --
balloonPtr      ds 2
colourPtr       ds 2
birdPtr         ds 2
birdFine        ds 1            ; HMP1 and delay of the bird
birdCoarse      ds 1
temp            ds 1
temp2           ds 1
digits          ds 12           ; pointers to the six columns of the score line
        echo "UPDRAFT: RAM up to", ., "stack from $FF down"

; ==== Stubs ==========================================================================================
; The first instruction changes the bank under the CPU's feet, and the next byte comes from the same address
; of the other bank: so both banks hold the same bytes here, and both have the vectors.
        mac STUB_BYTES
        bit SHOW_BANK_0         ; $xFD0: power on, whichever bank is there
        jmp Start
        bit SHOW_BANK_1         ; $xFD6: from bank 0, one frame of the rules
        jsr Rules
        bit SHOW_BANK_0
        rts
        endm

; ==== Bank 0: picture ================================================================================
        seg bank0
        org $0000
        rorg $D000

PowerOn         = $D000 + STUBS
CallRules       = $D000 + STUBS + 6

        include "updraft/display.asm"   ; code that counts cycles comes first: it must not cross pages
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
        lda #$A5
        sta random
        lda #HIDDEN
        sta starRow
        sta dartRow
        sta puffRow
        lda #RIGHT_EDGE
        sta birdX
        lda #40
        sta birdRow

Frame   lda #2
        sta WSYNC               ; completes the overscan
        sta VSYNC
        sta WSYNC
        sta WSYNC
        lda #RELEASE_TIME
        sta WSYNC
        sta TIM64T
        lda #0
        sta VSYNC

        inc frame
        jsr PrepareDisplay
.vblank lda INTIM
        bne .vblank
        sta WSYNC
        jsr ReleasePaddle
        jsr Display             ; returns at the start of the first overscan line

        lda #$82                ; ground the capacitors of the paddles, until ReleasePaddle
        sta VBLANK
        lda #OVERSCAN_TIME
        sta TIM64T
        jsr CallRules
.over   lda INTIM
        bne .over
        jmp Frame

        include "updraft/prepare.asm"
        include "updraft/graphics.asm"

        org STUBS
        rorg $D000 + STUBS
        STUB_BYTES
        org $0FFA
        rorg $DFFA
        .word PowerOn, PowerOn, PowerOn

; ==== Bank 1: rules ==================================================================================
        seg bank1
        org $1000
        rorg $F000

Rules   jsr Collide
        jsr Move
        jsr ReadConsole
        jmp PlayEffects

        include "updraft/rules.asm"
        include "updraft/collide.asm"
        include "updraft/console.asm"
        include "updraft/sound.asm"
        include "lib/points.asm"
        include "lib/random.asm"
        include "lib/effects.asm"

        org $1000 + STUBS
        rorg $F000 + STUBS
        STUB_BYTES
        org $1FFA
        rorg $FFFA
        .word $F000 + STUBS, $F000 + STUBS, $F000 + STUBS
