; Collide: the collision registers hold what touched in the field that was just shown (they are cleared
; between score and field, and nothing meets in the footer).

Collide subroutine
        lda phase
        cmp #PHASE_PLAY
        bne .rts
        bit CXM0P               ; bit 7: missile 0 with player 1
        bpl .birdFree
        lda #$20
        jsr AddScore
        lda #HIDDEN
        sta puffRow
        ldx #0
        ldy #EFFECT_BIRD
        jsr StartEffect
        jsr CountBird
.birdFree
        bit CXM0FB              ; bit 7: missile 0 with playfield
        bpl .puffFree
        lda #HIDDEN
        sta puffRow
.puffFree
        bit CXP0FB              ; bit 6: player 0 with ball
        bvc .noStar
        jsr HideStar
        lda #$10
        jsr AddScore
        ldx #0
        ldy #EFFECT_STAR
        jsr StartEffect
.noStar
        lda shield
        bne .rts
        bit CXP0FB              ; bit 7: player 0 with playfield, hills and clouds
        bmi LoseBalloon
        bit CXM1P               ; bit 7: missile 1 with player 0
        bmi LoseBalloon
        bit CXPPMM              ; bit 7: player 0 with player 1
        bmi LoseBalloon
.rts    rts

LoseBalloon subroutine
        dec lives
        lda #PHASE_HIT
        sta phase
        lda #HIT_TIME
        sta phaseTimer
        ldx #1
        ldy #EFFECT_CRASH
        jmp StartEffect
