; Prepare: from game state to what the kernel reads. Runs in the vertical blank.

; ==== PrepareDisplay: everything the picture needs, in the vertical blank ============================
PrepareDisplay
        jsr PrepareScore
        jsr PrepareShip
        jsr PrepareGlitches
        jsr PrepareColours
        ; fall through

PlaceAll subroutine
        lda #SCORE_X
        ldx #0
        jsr PlaceObject
        lda #SCORE_X+8
        inx
        jsr PlaceObject
        lda shotX
        inx
        jsr PlaceObject
        lda boltX
        inx
        jsr PlaceObject
        lda sparkX
        inx
        jsr PlaceObject
        sta WSYNC
        sta HMOVE
        lda #3                  ; three copies, each player shown with delay
        sta NUSIZ0
        sta NUSIZ1
        sta VDELP0
        sta VDELP1
        lda #$20                ; ball of four pixels, playfield not reflected
        sta CTRLPF
        ldx #5
.wait   dex                     ; HMxx may change 24 cycles after HMOVE
        bne .wait
        sta HMCLR
        rts

; -- shape pointers are set back by the row, so that the kernel's row number is the index
PrepareShip subroutine
        lda shipX
        jsr Divide15
        sta shipFine
        sty shipCoarse

        lda #>ShipShapes
        sta shipPtr+1
        lda #>ShipColours
        sta shipColourPtr+1
        ldx phase
        cpx #PHASE_HIT
        bne .whole
        lda #>BurstShapes
        sta shipPtr+1
        lda #>BurstColours
        sta shipColourPtr+1
.whole  lda #<ShipShapes+SHAPE_FIRST
        sec
        sbc shipRow
        sta shipColourPtr
        sta shipPtr
        txa
        beq .hide               ; no ship between games
        lda shield              ; a shielded ship blinks
        and #4
        bne .hide
        lda frame
        and #4
        beq .rts
        lda shipPtr
        clc
        adc #SHAPE_STRIDE       ; the second shape
        sta shipPtr
        rts
.hide   lda #<ShipShapes        ; nothing but blanks for 80 rows
        sta shipPtr
.rts    rts

PrepareGlitches subroutine
        ldx #LANES-1
.lane   lda glitchX,x
        jsr Divide15
        sta glitchFine,x
        sty glitchCoarse,x
        lda glitchState,x
        and #~GLITCH_DIR
        beq .alive
        ldy #<GlitchBlank
        cmp #GLITCH_BURST
        bcc .set
        ldy #<GlitchBurst
        bcs .set
.alive  ldy GlitchKinds,x
        lda frame
        and #8
        beq .set
        tya
        clc
        adc #LANE_ROWS          ; the second shape of its kind
        tay
.set    tya
        sec
        sbc LaneEnds,x
        sta glitchShape,x
        dex
        bpl .lane
        lda #>GlitchShapes
        sta glitchPtr+1
        rts

; -- the beam has the hue of the wave and a flickering heart; the spark twinkles
PrepareColours subroutine
        ldx wave
        lda BeamHues,x
        sta beamColour
        sta beamColour+3
        ora #$0E
        sta beamColour+1
        sta beamColour+2
        lda frame
        and #1
        tax
        lda #WHITE
        sta beamColour+1,x      ; one of the two middle rows
        lda frame
        lsr
        and #3
        tax
        lda SparkColours,x
        sta sparkColour
        rts
