; Horizontal positions, the usual way: coarse by waiting for the beam, fine by HMOVE.

; Object X (0, 1 player, 2, 3 missile, 4 ball) to position A.
; Pixel A + 6 for players, A + 5 for the others, after the next HMOVE; A = 0..149. Takes the next line; up to
; A = 134 it returns before the end of that line.
; 15 pixels are 5 cycles, one round of the loop; the rest of the division, -15..-1, becomes HMxx.
PlaceObject subroutine
        sta WSYNC
        sec                     ;  2
        PAGE_BEGIN
.coarse sbc #15
        bcs .coarse             ;  1+5n
        eor #7                  ;  3+5n
        asl
        asl
        asl
        asl                     ; 11+5n
        sta.w HMP0,x            ; 16+5n
        sta RESP0,x             ; 20+5n
        rts
        PAGE_END

; The same in advance: position A to rounds of the delay loop in Y and HMxx in A.
Divide15 subroutine
        ldy #0
        sec
.coarse iny
        sbc #15
        bcs .coarse
        eor #7
        asl
        asl
        asl
        asl
        rts
