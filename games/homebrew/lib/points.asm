; Adds A (BCD, two digits) to the score.
AddScore subroutine
        sed
        clc
        adc score+2
        sta score+2
        lda score+1
        adc #0
        sta score+1
        lda score
        adc #0
        sta score
        cld
        rts
