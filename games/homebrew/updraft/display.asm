; Display: the 192 lines of the picture, and the paddle.
;    16  score (or, between games, title and score in turn)
;   160  field: 80 rows of two lines
;    16  footer: edge of the field, balloons left, wave
;
; Cycle counts in comments are cycles of the line used up after the instruction; 22.67 cycles is the left
; edge of the picture, 76 the end of the line.
;
; The paddle is a resistor that charges a capacitor: at the least resistance the capacitor is charged 7 lines
; after its release, at the most after 198, in the middle after 102. Released 22 lines before the field, a
; paddle in the middle is read just when the beam is in the middle of the field. So no arithmetic is needed:
; the row that the beam has reached is where the balloon is.

; ==== The field kernel ===============================================================================
; Stack trick: with the stack pointer at ENABL three PHPs write the status byte to ENABL, ENAM1, ENAM0.
; Z is bit 1 of that byte, which is the bit that enables: an object is shown where a comparison gives 0.
;
; In: Y = 80, A = colour of the balloon in that row. Used: A, X, Y, stack pointer.
        PAGE_BEGIN
FieldKernel subroutine
; -- line A: objects
.row    sta WSYNC               ; 50
        sta COLUP0              ;  3
        lda (balloonPtr),y      ;  8
        sta GRP0                ; 11
        lda (birdPtr),y         ; 16
        sta GRP1                ; 19
        ldx #ENABL              ; 21
        txs                     ; 23
        tya                     ; 25
        eor starRow             ; 28    star: rows 2k and 2k+1
        and #$FE                ; 30
        php                     ; 33
        cpy dartRow             ; 36    dart: one row
        php                     ; 39
        tya                     ; 41
        eor puffRow             ; 44    puff: as the star
        and #$FE                ; 46
        php                     ; 49
        lda INPT0               ; 52    still charging? then the paddle is lower than this row
        bmi .charged            ; 54
        sty paddleRow           ; 57
; -- line B: background
.charged
        sta WSYNC               ; 60
        lda SkyColours,y        ;  4
        sta COLUBK              ;  7
        lda Hills1,y            ; 11
        sta PF1                 ; 14
        lda PlayfieldColours,y  ; 18
        sta COLUPF              ; 21
        lda Hills2,y            ; 25
        sta PF2                 ; 28    shown from 39
        lda Hills0,y            ; 32
        sta PF0                 ; 35    too late for the left edge, which follows a line later
        dey                     ; 37
        beq .done               ; 39
        lda (colourPtr),y       ; 44
        jmp .row                ; 47
.done   ldx #0
        beq Footer
        PAGE_END

        include "lib/footer.asm"

; ==== Display ========================================================================================
; Called at the start of line 0; the stack pointer must be $FD (the field kernel destroys it).
Display subroutine
        lda #0
        sta VBLANK
        sta WSYNC               ;       line 1
        sta WSYNC               ;       line 2
        jsr ShowDigits          ;       lines 3 to 11
        lda #$20                ;       one copy, puff of four pixels
        sta NUSIZ0
        ldx #0
        lda #BALLOON_X
        jsr PlaceObject         ;       line 12
; -- the bird to its place: the arithmetic of PlaceObject has been done by PrepareBird
        sta WSYNC               ;       line 13
        lda #$30                ;  2    one copy, dart of eight pixels
        sta NUSIZ1              ;  5
        lda birdFine            ;  8
        sta HMP1                ; 11
        ldx birdCoarse          ; 14
        nop                     ; 16
        nop                     ; 18
        PAGE_BEGIN
.coarse dex
        bne .coarse             ; 17+5n
        sta RESP1               ; 20+5n
        PAGE_END
        sta WSYNC               ;       line 14
        sta HMOVE
        ldx wave
        lda BirdColours,x
        sta COLUP1
        ldy #FIELD_ROWS
        sta WSYNC               ;       line 15
        lda (colourPtr),y
        sta CXCLR               ;       whatever the score touched does not count
        jmp FieldKernel

; Called in line 31 of the VBLANK; returns at the start of the picture. The capacitors have been grounded
; since the start of the overscan.
ReleasePaddle subroutine
        lda #2
        sta VBLANK              ;       bit 7 goes to 0
        lda #FIELD_ROWS
        sta paddleRow           ;       charged before the field begins: the top
        ldx #RELEASE_LINES
.line   sta WSYNC
        dex
        bne .line
        rts
