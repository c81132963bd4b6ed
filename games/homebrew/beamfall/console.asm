; Console: the switches, and what starts a game.

; ==== Console switches, start and end of a game ======================================================
ReadConsole subroutine
        jsr NextRandom
        lda SWCHA
        cmp #$FF
        beq .still
        jsr NextRandom          ; what the player does changes what comes
.still  lda SWCHB
        lsr
        bcc NewGame             ; RESET
        lda phase
        bne .rts
        lda phaseTimer
        beq .fire
        dec phaseTimer
        rts
.fire   bit INPT4
        bpl NewGame
.rts    rts

NewGame subroutine
        ldx #0
        stx score
        stx score+1
        stx score+2
        stx wave
        stx beamCount
        stx effectTime
        stx effectTime+1
        lda #LIVES
        sta lives
        jsr PlaceGlitches
        ; fall through

NewShip subroutine
        lda #PHASE_PLAY
        sta phase
        lda #SHIP_START_X
        sta shipX
        lda #SHIP_START_ROW
        sta shipRow
        lda #SHIELD_TIME
        sta shield
        lda #HIDDEN
        sta shotRow
        sta boltRow
        jsr HideSpark
        jmp NewBeam

ShowAttract subroutine
        lda #HIDDEN
        sta shotRow
        sta boltRow
        jsr HideSpark
        jsr PlaceGlitches
        jmp NewBeam
