; Collide: the collision registers hold what touched in the field that was just shown (they are cleared
; between score and field, and nothing meets in the footer).

Collide subroutine
        lda phase
        cmp #PHASE_PLAY
        bne .rts
; -- shot
        bit CXM0FB              ; bit 7: missile 0 with playfield
        bpl .beamMissed
        jsr BurnBeam
        jmp .shotDone
.beamMissed
        bit CXM0P               ; bit 7: missile 0 with player 1
        bpl .shotDone
        jsr HitGlitch
.shotDone
; -- bolt and spark: the beam takes them
        bit CXM1FB              ; bit 7: missile 1 with playfield
        bpl .boltFree
        lda #HIDDEN
        sta boltRow
.boltFree
        bit CXP0FB              ; bit 6: player 0 with ball
        bvc .notTaken
        jsr TakeSpark
.notTaken
        bit CXBLPF              ; bit 7: ball with playfield
        bpl .sparkFree
        jsr HideSpark
.sparkFree
; -- ship
        lda shield
        bne .rts
        bit CXP0FB              ; bit 7: player 0 with playfield
        bmi LoseShip
        bit CXM1P               ; bit 7: missile 1 with player 0
        bmi LoseShip
        bit CXPPMM              ; bit 7: player 0 with player 1
        bpl .rts
        lda shipRow             ; a burst does no harm: is one alive in the lanes of the ship?
        jsr LaneOfRow
        beq LoseShip
        lda shipRow
        clc
        adc #SHIP_ROWS-1
        jsr LaneOfRow
        beq LoseShip
.rts    rts

; Row A to its lane in X. Z: the glitch of the lane is alive.
LaneOfRow subroutine
        lsr
        lsr
        lsr
        lsr
        tax
        lda glitchState,x
        and #~GLITCH_DIR
        rts

LoseShip subroutine
        dec lives
        lda #PHASE_HIT
        sta phase
        lda #HIT_TIME
        sta phaseTimer
        lda #HIDDEN
        sta shotRow
        ldx #1
        ldy #EFFECT_CRASH
        jmp StartEffect

; The shot is two pixels wide and can touch two cells: both go.
BurnBeam subroutine
        lda shotX
        clc
        adc #5
        pha
        lsr
        lsr
        tax
        jsr ClearCell
        pla
        clc
        adc #1
        lsr
        lsr
        tax
        jsr ClearCell
        lda #HIDDEN
        sta shotRow
        lda #$01
        jsr AddScore
        ldx #0
        ldy #EFFECT_BURN
        jmp StartEffect

; The higher the lane, the more it is worth. Shots fly through a burst.
HitGlitch subroutine
        lda shotRow
        jsr LaneOfRow
        bne .rts
        lda glitchState,x
        ora #GLITCH_DEAD
        sta glitchState,x
        lda #HIDDEN
        sta shotRow
        lda GlitchPoints,x
        jsr AddScore
        ldx #0
        ldy #EFFECT_GLITCH
        jmp StartEffect
.rts    rts

GlitchPoints    .byte $05, $10, $15, $20, $25

TakeSpark subroutine
        jsr HideSpark
        lda #$25
        jsr AddScore
        ldx #0
        ldy #EFFECT_SPARK
        jmp StartEffect
