; Beam: how it falls, its cells, and what comes after it.

MoveBeam subroutine
        lda wave
        asl
        asl
        asl
        asl
        adc #BEAM_SPEED
        bit SWCHB               ; left difficulty A: faster
        bvc .speed
        adc #BEAM_SPEED_A
.speed  sta temp
        lda beamFrac
        sec
        sbc temp
        sta beamFrac
        bcs .rts
        dec beamRow
        bne .rts
        lda phase
        cmp #PHASE_PLAY
        bne NewBeam
        lda #$10                ; survived
        jsr AddScore
        inc beamCount
        lda beamCount
        cmp #BEAMS_PER_WAVE
        bcc .pass
        jsr NextWave
        jmp NewBeam
.pass   ldy #EFFECT_PASS
        ldx #0
        jsr StartEffect
        jmp NewBeam
.rts    rts

NextWave subroutine
        lda #0
        sta beamCount
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
        jmp StartEffect

; A whole beam at the top, then a gap somewhere; it narrows with the waves. Left difficulty A: a gap of 5 to
; 3 cells of four pixels instead of 7 to 5. The ship is two cells wide.
NewBeam subroutine
        lda #BEAM_START
        sta beamRow
        ldx #5
        lda #$FF
.whole  sta beamCells,x
        dex
        bpl .whole
        jsr NextRandom
        and #$1F
        adc #0                  ; the first cell, 0 to 32
        tax
        lda wave
        lsr
        lsr
        sta temp
        lda #GAP_B
        bit SWCHB
        bvc .gap
        lda #GAP_A
.gap    sec
        sbc temp
        sta temp
.cell   jsr ClearCell
        inx
        dec temp
        bne .cell
        rts

; Cell X (0..39 from the left) of the beam goes dark.
ClearCell subroutine
        ldy CellByte,x
        lda beamCells,y
        and CellMask,x
        sta beamCells,y
        rts

; PF0 shows bits 4 to 7, PF1 bits 7 to 0, PF2 bits 0 to 7.
CellByte
        .byte 0, 0, 0, 0,  1, 1, 1, 1, 1, 1, 1, 1,  2, 2, 2, 2, 2, 2, 2, 2
        .byte 3, 3, 3, 3,  4, 4, 4, 4, 4, 4, 4, 4,  5, 5, 5, 5, 5, 5, 5, 5
CellMask
        .byte $EF, $DF, $BF, $7F,  $7F, $BF, $DF, $EF, $F7, $FB, $FD, $FE
        .byte $FE, $FD, $FB, $F7, $EF, $DF, $BF, $7F
        .byte $EF, $DF, $BF, $7F,  $7F, $BF, $DF, $EF, $F7, $FB, $FD, $FE
        .byte $FE, $FD, $FB, $F7, $EF, $DF, $BF, $7F
