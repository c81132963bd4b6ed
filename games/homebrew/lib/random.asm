; 16-bit Galois shift register, x^16 + x^14 + x^13 + x^11 + 1. Returns its low byte.
NextRandom subroutine
        lsr random+1
        ror random
        bcc .rts
        lda random+1
        eor #$B4
        sta random+1
.rts    lda random
        rts
