; Display: from game state to picture. The picture has 192 lines:
;    16  score (or, between games, title and score in turn)
;   160  field: 5 lanes of a rail (2 lines) and 15 rows (30 lines)
;    16  footer: lowest rail, ships left, wave
;
; Cycle counts in comments are cycles of the line used up after the instruction; 22.67 cycles is the left
; edge of the picture, 76 the end of the line. The kernel must not cross a page inside its loops, so this
; file comes first in the image.

; ==== The field kernel ===============================================================================
; Per row: ship and glitch from shape pointers, ball and missiles by the stack trick, beam by playfield.
;
; Stack trick: with the stack pointer at ENABL three PHPs write the status byte to ENABL, ENAM1, ENAM0.
; Z is bit 1 of that byte, which is the bit that enables: an object is shown where a comparison gives 0.
;
; Rows are two lines, A and B. Line A sets up everything for the row, line B shows the beam, which needs
; six playfield writes at their moments. So the beam is drawn on every second line only, like a raster.
;
; It is entered at Field, in the rail of the highest lane, with X = 0, Y = 80, lane, nextCoarse, HMP1 and
; railColour set for that lane. Used: A, X, Y, stack pointer.
        PAGE_BEGIN
FieldKernel subroutine
; -- line A
.row    sta WSYNC               ; 75 at most. Here: X = 0, carry set, A = colour of the ship
        sta COLUP0              ;  3
        lda (shipPtr),y         ;  8
        sta GRP0                ; 11
        lda (glitchPtr),y       ; 16
        sta GRP1                ; 19
        stx PF1                 ; 22    beam off again, before PF1 is shown at 28 and PF2 at 39
        stx PF2                 ; 25
.objects
        ldx #ENABL              ; 27
        txs                     ; 29
        tya                     ; 31
        eor sparkRow            ; 34    spark: rows 2k and 2k+1, so that one comparison is enough
        and #$FE                ; 36
        php                     ; 39
        tya                     ; 41
        sbc boltRow             ; 44    carry is still set
        and #$FE                ; 46    bolt: this row and the one above
        php                     ; 49
        tya                     ; 51
        eor shotRow             ; 54    shot: as the spark
        and #$FE                ; 56
        php                     ; 59
        tya                     ; 61
        sec                     ; 63
        sbc beamRow             ; 66
        cmp #BEAM_ROWS          ; 68
        bcs .dark               ; 70
        tax                     ; 72    0 = lowest row of the beam
; -- line B with the beam
        sta WSYNC               ; 75
        lda beamCells           ;  3
        sta PF0                 ;  6
        lda beamCells+1         ;  9
        sta PF1                 ; 12
        lda beamColour,x        ; 16
        sta COLUPF              ; 19
        lda beamCells+2         ; 22
        sta PF2                 ; 25
        lda beamCells+3         ; 28
        sta PF0                 ; 31    left PF0 is over at 28, right PF0 starts at 50
        dey                     ; 33
        ldx #0                  ; 35
        lda beamCells+4         ; 38
        sta PF1                 ; 41    left PF1 is over at 39, right PF1 starts at 55
        lda beamCells+5         ; 44
        nop                     ; 46
        nop                     ; 48
        sta PF2                 ; 51    left PF2 is over at 50, right PF2 starts at 66
        lda (shipColourPtr),y   ; 56
        stx PF0                 ; 59    right PF0 is over at 55; PF1 and PF2 must wait for line A
        cpy laneEnd             ; 62    sets carry: Y >= laneEnd
        bne .row                ; 65
        beq .next               ; 67
; -- line B without it
.dark   sta WSYNC               ; 74
        lda sparkColour         ;  3
        sta COLUPF              ;  6
        dey
        ldx #0
        lda (shipColourPtr),y
        cpy laneEnd
        bne .row
.next   tya                     ; 69
        beq Footer              ; 71

; -- rail, first line: a bright line; meanwhile player 1 gets its coarse position
Field   sta WSYNC
        stx PF1                 ;  3    the beam may have been on in the row above
        stx PF2                 ;  6
        lda.w railColour        ; 10    absolute, to wait for a cycle
        sta COLUBK              ; 13
        dey                     ; 15
        ldx nextCoarse          ; 18
.coarse dex
        bne .coarse             ; 17+5n
        sta RESP1               ; 20+5n as in PlaceObject, n = 1..10
; -- rail, second line: fine position, everything that belongs to the lane
        sta WSYNC
        sta HMOVE               ;  3    only HMP1 is not 0
        ldx lane                ;  6
        lda #0                  ;  8    black: this hides the eight black pixels of HMOVE
        sta COLUBK              ; 11
        lda LaneColours,x       ; 15
        sta laneColour          ; 18
        lda GlitchColours,x     ; 22
        sta COLUP1              ; 25
        lda glitchShape,x       ; 29
        sta glitchPtr           ; 32
        lda glitchCoarse-1,x    ; 36    what the next rail needs; nothing uses it after lane 0
        sta nextCoarse          ; 39
        lda glitchFine-1,x      ; 43
        sta HMP1                ; 46    no earlier than 24 cycles after HMOVE
        lda RailColours-1,x     ; 50
        sta railColour          ; 53
        lda LaneEnds,x          ; 57
        sta laneEnd             ; 60
        dec lane                ; 65
        ldx #0                  ; 67
        lda (shipColourPtr),y   ; 72
; -- line A of the highest row: the colour of the lane; GRP1, PF1 and PF2 are 0 already
        sta WSYNC               ; 75
        sta COLUP0              ;  3
        lda laneColour          ;  6
        sta COLUBK              ;  9
        lda (shipPtr),y         ; 14
        sta GRP0                ; 17
        sec                     ; 19
        jmp .objects            ; 22    three cycles earlier than the other rows
        PAGE_END

        include "lib/footer.asm"

; ==== Display: the 192 lines of the picture ==========================================================
; Called at the start of line 0; the stack pointer must be $FD (the field kernel destroys it).
Display subroutine
        lda #0
        sta VBLANK
        sta WSYNC               ;       line 1
        sta WSYNC               ;       line 2
        jsr ShowDigits          ;       lines 3 to 11
        lda #$10                ;       one copy, missiles of two pixels
        sta NUSIZ0
        sta NUSIZ1
; -- the ship to its place: the arithmetic of PlaceObject has been done by PrepareDisplay
        sta WSYNC               ;       line 12
        lda shipFine            ;  3
        sta HMP0                ;  6
        lda #SHOT_COLOUR        ;  8
        sta COLUP0              ; 11
        ldx shipCoarse          ; 14
        nop                     ; 16
        nop                     ; 18
        PAGE_BEGIN
.coarse dex
        bne .coarse             ; 17+5n
        sta RESP0               ; 20+5n
        PAGE_END
        sta WSYNC               ;       line 13
        sta HMOVE
        lda #LANES-1
        sta lane
        lda glitchCoarse+LANES-1
        sta nextCoarse
        lda #TOP_RAIL
        sta railColour
        ldy #FIELD_ROWS
        ldx #0
        sta WSYNC               ;       line 14
        sta HMCLR
        lda glitchFine+LANES-1
        sta HMP1
        sta WSYNC               ;       line 15
        sta CXCLR               ;       whatever the score touched does not count
        jmp Field
