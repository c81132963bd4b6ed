; Prepare: from game state to what the kernel reads, in the vertical blank.

PrepareDisplay
        jsr PrepareScore
        jsr PrepareBalloon
        jsr PrepareBird
        ; fall through

PlaceAll subroutine
        lda #SCORE_X
        ldx #0
        jsr PlaceObject
        lda #SCORE_X+8
        inx
        jsr PlaceObject
        lda puffX
        inx
        jsr PlaceObject
        lda dartX
        inx
        jsr PlaceObject
        lda starX
        inx
        jsr PlaceObject
        sta WSYNC
        sta HMOVE
        lda #3                  ; three copies, each player shown with delay
        sta NUSIZ0
        sta NUSIZ1
        sta VDELP0
        sta VDELP1
        lda #$21                ; ball of four pixels, playfield reflected
        sta CTRLPF
        ldx #5
.wait   dex                     ; HMxx may change 24 cycles after HMOVE
        bne .wait
        sta HMCLR
        rts

; Shape pointers are set back by the row, so that the kernel's row number is the index.
PrepareBalloon subroutine
        lda #>BalloonColours
        sta colourPtr+1
        lda #<BalloonColours+FIELD_ROWS
        sec
        sbc balloonRow
        sta colourPtr
        ldx #>BalloonShape
        lda phase
        cmp #PHASE_HIT
        bne .whole
        ldx #>BurstShape
.whole  stx balloonPtr+1
        tax
        beq .hide               ; no balloon between games
        lda shield              ; a shielded balloon blinks
        and #4
        bne .hide
        lda colourPtr           ; shape and colours lie at the same place of their pages
        sta balloonPtr
        rts
.hide   lda #0                  ; nothing but blanks for 80 rows
        sta balloonPtr
        rts

PrepareBird subroutine
        lda birdX
        jsr Divide15
        sta birdFine
        sty birdCoarse
        lda #>BirdShapes
        sta birdPtr+1
        lda frame
        and #8
        beq .up
        lda #BIRD_STRIDE
.up     clc
        adc #<BirdShapes+FIELD_ROWS
        sec
        sbc birdRow
        sta birdPtr
        rts
