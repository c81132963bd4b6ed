; Graphics: shapes (lowest line first, because the kernel's row numbers count down), colours, tables.

; ==== Colours ========================================================================================
FOOTER_LIVES_X  = 6
FOOTER_WAVE_X   = 134

SCORE_COLOUR    = $2C
TITLE_COLOUR    = $3C
FOOTER_RAIL     = $D2
FOOTER_BACK     = $00
FOOTER_SHIP     = $46
FOOTER_DIGIT    = $2C
HILL            = $C4
STAR            = $1E
CLOUD           = $04
PUFF            = $0E

BirdColours     .byte $04, $44, $02, $84, $64, $24, $C4, $A4, $0E     ; by wave
LifeShape       .byte $18, $18, $00, $18, $3C, $7E, $7E, $3C

; ==== Digits and title ===============================================================================
        align 256
        PAGE_BEGIN
        include "lib/font.asm"
FontTitle
        .byte $00, $0E, $11, $11, $11, $11, $11, $11
        .byte $00, $41, $41, $41, $79, $45, $45, $79
        .byte $00, $E4, $14, $15, $17, $14, $14, $E7
        .byte $00, $51, $91, $11, $9F, $51, $51, $8E
        .byte $00, $40, $40, $40, $78, $40, $40, $7D
        .byte $00, $40, $40, $40, $40, $40, $40, $F0
        PAGE_END

; ==== Balloon ========================================================================================
; The kernel reads shape + (row - balloon's row) for rows 80..1: there must be 80 blanks below and above. The
; first 80 bytes alone are a hidden balloon. Colours lie at the same place of another page.
        align 256
BalloonShape
        ds 80, 0
        .byte %00011000         ; basket
        .byte %00111100
        .byte %00100100
        .byte %00000000
        .byte %00100100
        .byte %00111100
        .byte %01111110
        .byte %11111111
        .byte %11111111
        .byte %11111111
        .byte %01111110
        .byte %00111100
        ds 80, 0

        align 256
BurstShape
        ds 80, 0
        .byte %00011000
        .byte %00111100
        .byte %00100100
        .byte %01000010
        .byte %00000000
        .byte %10010001
        .byte %01000010
        .byte %00100100
        .byte %11000011
        .byte %00100100
        .byte %01000010
        .byte %10010001
        ds 80, 0

        align 256
BalloonColours                  ; of a row; the puff is drawn in these as well
        ds 80, PUFF
        .byte $24, $24, $06, $2E, $38, $46, $1A, $46, $1A, $46, $1A, $46
        ds 80, PUFF

; ==== Bird ===========================================================================================
BIRD_STRIDE     = 80
        align 256
BirdShapes
        ds 80, 0
        .byte %00000000
        .byte %00111000
        .byte %11111100
        .byte %01111111
        .byte %00110000
        .byte %01100000
        .byte %11000000
        .byte %00000000
        ds 72, 0
        .byte %01100000
        .byte %00110000
        .byte %11111000
        .byte %01111111
        .byte %00011100
        .byte %00000000
        .byte %00000000
        .byte %00000000
        ds 72, 0

; ==== Background, rows 0 to 80 =======================================================================
        align 256
        PAGE_BEGIN
SkyColours
        ds 6, $2A
        ds 6, $28
        ds 7, $38
        ds 7, $36
        ds 8, $46
        ds 8, $44
        ds 9, $54
        ds 9, $52
        ds 10, $62
        ds 9, $60
        ds 2, CLOUD             ; where PF0 comes too late to cover it all
PlayfieldColours                ; hills, the star, clouds
        ds 4, HILL-2
        ds 6, HILL
        ds 6, HILL+2
        ds 61, STAR
        ds 4, CLOUD
        PAGE_END

; The left half of the playfield; the right half is its mirror image. Hills at the bottom, clouds at the top.
; PF0 shows bits 4 to 7, PF1 bits 7 to 0, PF2 bits 0 to 7.
        align 256
        PAGE_BEGIN
Hills1                          ; PF1
        .byte 0
        .byte %11111111
        .byte %11111111
        .byte %11111111
        .byte %11111011
        .byte %11110001
        .byte %01110001
        .byte %01100000
        .byte %00100000
        .byte %00000000
        .byte %00000000
        .byte %00000000
        .byte %00000000
        .byte %00000000
        .byte %00000000
        ds 62, 0
        .byte %00010010
        .byte %10111011
        .byte %11111111
        .byte %11111111

Hills2                          ; PF2
        .byte 0
        .byte %11111111
        .byte %11111111
        .byte %11111111
        .byte %11111001
        .byte %11110001
        .byte %11110000
        .byte %11100000
        .byte %11100000
        .byte %11100000
        .byte %11000000
        .byte %11000000
        .byte %11000000
        .byte %10000000
        .byte %10000000
        ds 62, 0
        .byte %01001000
        .byte %11011101
        .byte %11111111
        .byte %11111111

        PAGE_END

        align 256
Hills0                          ; PF0
        .byte 0
        .byte %11110000
        .byte %11110000
        .byte %11110000
        .byte %11110000
        .byte %00110000
        .byte %00010000
        .byte %00000000
        .byte %00000000
        .byte %00000000
        .byte %00000000
        .byte %00000000
        .byte %00000000
        .byte %00000000
        .byte %00000000
        ds 62, 0
        .byte %00000000
        .byte %11100000
        .byte %11110000
        .byte %11110000
