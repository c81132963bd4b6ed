; The footer, 16 lines: ships left and the wave. The kernels of the games branch here from the last line of the
; field, with X = 0. The game gives colours and positions FOOTER_xxx, LifeShape, and LIVES of at most 4.

Footer  sta WSYNC               ;       line 176: the edge of the field
        lda #FOOTER_RAIL
        sta COLUBK
        stx PF0
        stx PF1
        stx PF2
        stx GRP0
        stx GRP1
        stx ENABL
        stx ENAM0
        stx ENAM1
        ldx #$FD                ;       the stack as it was: Display is called from the frame loop only
        txs
        sta WSYNC               ;       line 177
        lda #FOOTER_BACK
        sta COLUBK
        sta HMCLR
        ldx #0
        lda #FOOTER_LIVES_X
        jsr PlaceObject         ;       line 178
        inx
        lda #FOOTER_WAVE_X
        jsr PlaceObject         ;       line 179
        sta WSYNC               ;       line 180
        sta HMOVE
        ldx lives               ;       one is in play, the others are shown
        lda LivesCopies,x
        sta NUSIZ0
        lda LivesMask,x
        sta temp
        lda #FOOTER_SHIP
        sta COLUP0
        lda #FOOTER_DIGIT
        sta COLUP1
        sta WSYNC               ;       line 181
        ldx wave
        inx
        txa
        asl
        asl
        asl
        sta digits
        ldy #7
.line   sta WSYNC               ;       lines 182 to 189
        lda LifeShape,y
        and temp
        sta GRP0
        lda (digits),y
        sta GRP1
        dey
        bpl .line
        sta WSYNC               ;       line 190
        iny
        sty GRP0
        sty GRP1
        sty GRP0                ;       the score line would show the delayed copy of GRP1
        sta WSYNC               ;       line 191
        sta WSYNC               ;       the first line of the overscan
        lda #2
        sta VBLANK
        rts

LivesCopies     .byte $10, $10, $10, $11, $13   ; NUSIZ0 for 0, 0, 1, 2, 3 ships
LivesMask       .byte $00, $00, $FF, $FF, $FF
