; Console: the switches, and what starts a game.

ReadConsole subroutine
        jsr NextRandom
        bit SWCHA
        bmi .idle
        jsr NextRandom          ; what the player does changes what comes
.idle   lda SWCHB
        lsr
        bcc NewGame             ; RESET
        lda phase
        bne .rts
        lda phaseTimer
        beq .button
        dec phaseTimer
        rts
.button bit SWCHA
        bpl NewGame
.rts    rts

NewGame subroutine
        ldx #0
        stx score
        stx score+1
        stx score+2
        stx wave
        stx birdCount
        stx effectTime
        stx effectTime+1
        lda #LIVES
        sta lives
        ; fall through

NewBalloon subroutine
        lda #PHASE_PLAY
        sta phase
        lda #SHIELD_TIME
        sta shield
        lda #HIDDEN
        sta puffRow
        lda #BALLOON_START
        sta balloonRow
        jsr HideStar
        jsr HideDart
        jmp NewBird
