; Play: everything moves one frame on.

; ==== One frame ======================================================================================
Play subroutine
        jsr MoveShot
        jsr MoveBolt
        jsr MoveGlitches
        jsr MoveSpark
        jsr MoveBeam
        lda phase
        cmp #PHASE_HIT
        beq ShipBurns
        lsr                     ; PHASE_PLAY is 1, PHASE_OVER 0
        bcc .rts
        lda shield
        beq .play
        dec shield
.play   jsr MoveShip
        jmp Shoot
.rts    rts

; -- after the burst: the next ship, or the end
ShipBurns subroutine
        dec phaseTimer
        bne .rts
        lda lives
        beq .over
        jmp NewShip
.over   sta phase               ; PHASE_OVER is 0
        lda #OVER_TIME
        sta phaseTimer
.rts    rts

; ==== Ship and shot ==================================================================================
; 3 pixels in two frames to the sides, 1 row in two frames up and down: the same speed, a row is two lines.
MoveShip subroutine
        lda frame
        and #1
        sta temp
        lda SWCHA
        sta temp2
        asl temp2               ; right
        bcs .left
        lda shipX
        sec
        adc temp
        cmp #RIGHT_EDGE
        bcc .setX
        lda #RIGHT_EDGE
.setX   sta shipX
.left   asl temp2
        bcs .down
        lda shipX
        clc
        sbc temp
        bcs .setLeft
        lda #0
.setLeft sta shipX
.down   lda temp                ; up and down in every second frame
        beq .rts
        asl temp2
        bcs .up
        lda shipRow
        cmp #2
        bcc .up
        dec shipRow
.up     asl temp2
        bcs .rts
        lda shipRow
        cmp #SHIP_TOP_ROW
        bcs .rts
        inc shipRow
.rts    rts

; One shot at a time, so the nearer the target the faster the fire. The gun is a pixel left of the middle: so
; there is no place where shots straight up burn all the cells that the ship needs; one must sweep.
Shoot subroutine
        lda shotRow
        cmp #HIDDEN
        bne .rts
        bit INPT4
        bmi .rts
        lda shipX
        clc
        adc #3                  ; a missile's position + 5 = the ship's + 6 + 2
        sta shotX
        lda shipRow
        clc
        adc #SHIP_ROWS
        sta shotRow
        ldy #EFFECT_SHOT
        ldx #0
        jmp StartEffect
.rts    rts

MoveShot subroutine
        lda shotRow
        cmp #HIDDEN
        beq .rts
        clc
        adc #SHOT_SPEED
        cmp #FIELD_ROWS
        bcc .set
        lda #HIDDEN
.set    sta shotRow
.rts    rts

; ==== Glitches and their bolt ========================================================================
PlaceGlitches subroutine
        ldx #LANES-1
.lane   lda GlitchStarts,x
        sta glitchX,x
        lda GlitchDirs,x
        sta glitchState,x
        dex
        bpl .lane
        rts

MoveGlitches subroutine
        ldx #LANES-1
.lane   lda glitchState,x
        and #~GLITCH_DIR
        bne .dead
        lda wave                ; speed of the lane, and 16/256 pixel a frame more in every wave
        asl
        asl
        asl
        asl
        clc
        adc GlitchSpeeds,x
        bcs .move               ; a pixel in every frame is the most
        adc glitchFrac,x
        sta glitchFrac,x
        bcc .next
.move   lda glitchState,x
        bmi .left
        inc glitchX,x
        lda glitchX,x
        cmp #RIGHT_EDGE
        bcs .turn
        bcc .next
.left   dec glitchX,x
        bne .next
.turn   lda glitchState,x
        eor #GLITCH_DIR
        sta glitchState,x
.next   dex
        bpl .lane
        rts
.dead   cpx #0                  ; the lowest lane stays empty in the first waves
        bne .count
        ldy wave
        cpy #FULL_WAVE
        bcc .next
.count  dec glitchState,x       ; the count is not 0, so the direction stays
        cmp #1
        bne .next
        jsr NextRandom          ; it comes back at a side
        bmi .right
        lda #0
        sta glitchX,x
        sta glitchState,x
        beq .next
.right  lda #RIGHT_EDGE
        sta glitchX,x
        lda #GLITCH_DIR
        sta glitchState,x
        bne .next

; A living glitch above the ship drops the bolt; one at a time.
MoveBolt subroutine
        lda boltRow
        cmp #HIDDEN
        bne .fall
        jsr NextRandom
        and #$1F
        bne .rts
        lda random+1
        and #3
        tax
        inx                     ; lanes 1 to 4
        lda glitchState,x
        and #~GLITCH_DIR
        bne .rts
        lda LaneEnds,x
        cmp shipRow
        bcc .rts
        adc #2                  ; carry is set: row 3 of the lane
        sta boltRow
        lda glitchX,x
        clc
        adc #4
        sta boltX
.rts    rts

.fall   jsr BoltSpeed
        adc boltFrac
        sta boltFrac
        bcc .rts
        dec boltRow
        bne .rts
        lda #HIDDEN
        sta boltRow
        rts

; Rows / 256 a frame, carry clear. Left difficulty A: bolts are faster.
BoltSpeed subroutine
        lda wave
        asl
        asl
        asl
        ldx #BOLT_SPEED_B
        bit SWCHB
        bvc .b
        ldx #BOLT_SPEED_A
.b      stx temp
        adc temp
        bcc .rts
        lda #$FF
        clc
.rts    rts

GlitchStarts    .byte 10, 120, 40, 100, 70      ; lowest lane first
GlitchDirs      .byte 1, GLITCH_DIR, 0, GLITCH_DIR, 0   ; the lowest one has yet to come
GlitchSpeeds    .byte $48, $60, $54, $78, $90

; ==== Spark ==========================================================================================
; It drifts somewhere above the ground until the ship takes it or the beam does.
MoveSpark subroutine
        lda sparkRow
        cmp #HIDDEN
        bne .drift
        dec sparkTimer
        bne .rts
        jsr NextRandom
        and #$7F
        adc #8
        sta sparkX
        jsr NextRandom
        lsr
        and #$1E                ; an even row, 14 to 58, the middle ones more often
        sta sparkRow
        lda random+1
        and #$0E
        clc
        adc sparkRow
        adc #LOWEST_SPARK
        sta sparkRow
        ldx #1
        bit random
        bpl .step
        ldx #$FF
.step   stx sparkStep
.rts    rts
.drift  lda frame
        and #1
        bne .rts
        lda sparkX
        clc
        adc sparkStep
        sta sparkX
        beq .turn
        cmp #SPARK_RIGHT
        bcc .rts
.turn   lda sparkStep
        eor #$FE                ; 1 <-> $FF
        sta sparkStep
        rts

HideSpark subroutine
        lda #HIDDEN
        sta sparkRow
        lda #SPARK_WAIT
        sta sparkTimer
        rts
