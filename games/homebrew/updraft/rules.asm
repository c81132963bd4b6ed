; Rules: everything moves one frame on.

Move subroutine
        jsr MoveBird
        jsr MoveStar
        jsr MoveDart
        jsr MovePuff
        lda phase
        beq .rts
        cmp #PHASE_HIT
        beq BalloonBurns
        lda shield
        beq .play
        dec shield
.play   jsr MoveBalloon
        jmp Blow
.rts    rts

; -- after the burst: the next balloon, or the end
BalloonBurns subroutine
        dec phaseTimer
        bne .rts
        lda lives
        beq .over
        jmp NewBalloon
.over   sta phase               ; PHASE_OVER is 0
        lda #OVER_TIME
        sta phaseTimer
.rts    rts

; ==== Balloon and puff ===============================================================================
; The balloon drifts, a row a frame, to where the beam was when the paddle's capacitor was charged.
MoveBalloon subroutine
        lda paddleRow
        sec
        sbc #BALLOON_ROWS/2     ; from its middle to its lowest line
        bcc .down
        cmp balloonRow
        beq .rts
        bcc .down
        lda balloonRow
        cmp #BALLOON_TOP
        bcs .rts
        inc balloonRow
        rts
.down   lda balloonRow
        cmp #2
        bcc .rts
        dec balloonRow
.rts    rts

Blow subroutine
        lda puffRow
        cmp #HIDDEN
        bne .rts
        bit SWCHA               ; bit 7: button of paddle 0, 0 = pressed
        bmi .rts
        lda balloonRow
        clc
        adc #BALLOON_ROWS/2
        sta puffRow
        lda #BALLOON_X+8
        sta puffX
        ldy #EFFECT_PUFF
        ldx #0
        jmp StartEffect
.rts    rts

MovePuff subroutine
        lda puffRow
        cmp #HIDDEN
        beq .rts
        lda puffX
        clc
        adc #PUFF_SPEED
        sta puffX
        cmp #RIGHT_EDGE
        bcc .rts
        lda #HIDDEN
        sta puffRow
.rts    rts

; ==== Bird ===========================================================================================
; It flies to the left, faster in every wave, and from the second wave on up and down as well.
MoveBird subroutine
        lda wave
        asl
        asl
        asl
        sta temp
        asl
        adc temp                ; 24 times the wave, 192 at most: carry stays clear
        adc #BIRD_SPEED
        adc birdFrac
        sta birdFrac
        lda #1
        adc #0                  ; one pixel, or two when the fraction overflows
        sta temp
        lda birdX
        sec
        sbc temp
        sta birdX
        bcc BirdPasses
        lda wave
        beq .rts
        lda frame
        and #3
        bne .rts
        lda frame
        and #$20
        beq .down
        lda birdRow
        cmp #BIRD_TOP
        bcs .rts
        inc birdRow
        rts
.down   lda birdRow
        cmp #LOWEST_FLIGHT
        bcc .rts
        dec birdRow
.rts    rts

BirdPasses subroutine
        lda phase
        cmp #PHASE_PLAY
        bne NewBird
        lda #$05
        jsr AddScore
        ; fall through

; One bird less, by flight or by puff.
CountBird subroutine
        inc birdCount
        lda birdCount
        cmp #BIRDS_PER_WAVE
        bne NewBird
        lda #0
        sta birdCount
        lda wave
        cmp #LAST_WAVE
        bcs .life
        inc wave
.life   lda lives
        cmp #LIVES
        bcs .full
        inc lives
.full   ldy #EFFECT_WAVE
        ldx #1
        jsr StartEffect
        ; fall through

NewBird subroutine
        lda #RIGHT_EDGE
        sta birdX
        jsr RandomRow
        sta birdRow
        rts

; LOWEST_FLIGHT + 0..46, the middle more often than the ends.
RandomRow subroutine
        jsr NextRandom
        and #$1F
        sta temp
        lda random+1
        and #$0F
        clc
        adc temp
        adc #LOWEST_FLIGHT
        rts

; ==== Star and dart ==================================================================================
MoveStar subroutine
        lda starRow
        cmp #HIDDEN
        beq .wait
        dec starX
        bne .rts
        jmp HideStar
.wait   dec starTimer
        bne .rts
        jsr RandomRow
        sta starRow
        lda #RIGHT_EDGE
        sta starX
.rts    rts

HideStar subroutine
        lda #HIDDEN
        sta starRow
        lda #STAR_WAIT
        sta starTimer
        rts

; Darts come at the height of the balloon, more often in later waves.
MoveDart subroutine
        lda dartRow
        cmp #HIDDEN
        beq .wait
        lda dartX
        sec
        sbc #DART_SPEED
        sta dartX
        bcs .rts
        jmp HideDart
.wait   lda phase
        cmp #PHASE_PLAY
        bne .rts
        dec dartTimer
        bne .rts
        lda balloonRow
        clc
        adc #BALLOON_ROWS/2
        sta dartRow
        lda #RIGHT_EDGE
        sta dartX
        ldx #1
        ldy #EFFECT_DART
        jmp StartEffect
.rts    rts

HideDart subroutine
        lda #HIDDEN
        sta dartRow
        lda wave
        asl
        asl
        asl
        sta temp
        lda #DART_WAIT
        sec
        sbc temp
        sta dartTimer
        rts
