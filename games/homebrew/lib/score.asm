; The score line: six columns of eight lines from the pointers in digits, with both players in three copies.
; The font must start at a page: a glyph is eight bytes, so its number * 8 is the low byte of the pointer.

SCORE_X         = 50            ; where the caller places player 0; player 1 is 8 further

; The score; between games the title, in every other 128 frames.
PrepareScore subroutine
        ldx #11
        lda #>Font
.high   sta digits,x
        dex
        dex
        bpl .high
        lda phase
        bne .score
        bit frame
        bmi .title
.score  lda #SCORE_COLOUR
        sta COLUP0
        sta COLUP1
        ldx #0
        ldy #0
.byte   lda score,x             ; two digits of eight bytes each
        and #$F0
        lsr
        sta digits,y
        lda score,x
        and #$0F
        asl
        asl
        asl
        sta digits+2,y
        iny
        iny
        iny
        iny
        inx
        cpx #3
        bne .byte
        ldx #0                  ; blanks for leading zeros, but for the last digit
        ldy #<FontBlank
.zeros  lda digits,x
        bne .done
        sty digits,x
        inx
        inx
        cpx #10
        bne .zeros
.done   rts

.title  lda #TITLE_COLOUR
        sta COLUP0
        sta COLUP1
        ldx #10
        lda #<FontTitle+40
.column sta digits,x
        sec
        sbc #8
        dex
        dex
        bpl .column
        rts

; Call it in the line before the first line of digits. It returns in the line after the last.
; While a copy of one player is shown, the delay registers take the graphics of the other player's next copy:
; the four writes in a row must start at cycle 44.
ShowDigits subroutine
        ldy #7
        PAGE_BEGIN
.digits sty temp
        lda (digits),y
        sta GRP0
        sta WSYNC               ;       lines 1 to 8
        lda (digits+2),y        ;  5
        sta GRP1                ;  8    column 0 appears
        lda (digits+4),y        ; 13
        sta GRP0                ; 16    column 1 appears with the next write of GRP1
        lda (digits+6),y        ; 21
        sta temp2               ; 24
        lda (digits+8),y        ; 29
        tax                     ; 31
        lda (digits+10),y       ; 36
        tay                     ; 38
        lda temp2               ; 41
        sta GRP1                ; 44
        stx GRP0                ; 47
        sty GRP1                ; 50
        sta GRP0                ; 53
        ldy temp                ; 56
        dey                     ; 58
        bpl .digits             ; 61
        PAGE_END
        sta WSYNC               ;       line 9
        iny
        sty GRP0
        sty GRP1
        sty GRP0
        sty VDELP0
        sty VDELP1
        rts
