; Graphics: shapes (lowest line first, because the kernel's row numbers count down), colours, tables.

; ==== Colours ========================================================================================
FOOTER_LIVES_X  = 6
FOOTER_WAVE_X   = 134

SCORE_COLOUR    = $1A
TITLE_COLOUR    = $9C
SHOT_COLOUR     = $1E
WHITE           = $0E
TOP_RAIL        = $66
FOOTER_RAIL     = $B6
FOOTER_BACK     = $00
FOOTER_SHIP     = $98
FOOTER_DIGIT    = $1A

BeamHues        .byte $48, $38, $28, $18, $C8, $A8, $88, $68, $58
SparkColours    .byte $1C, $1E, $0E, $2C

; ==== Tables =========================================================================================
GlitchKinds     .byte <GlitchMite, <GlitchEye, <GlitchMite, <GlitchEye, <GlitchMite
LifeShape       .byte $24, $7E, $7E, $3C, $24, $3C, $18, $18

; ==== Ship ===========================================================================================
; The kernel reads shape + (row - ship's row) for rows 80..1: around every shape there must be blanks, 80
; below the first (a hidden ship is at row 80) and 72 above each.
SHAPE_FIRST     = 80
SHAPE_STRIDE    = 80

        align 256
ShipShapes
        ds 80, 0
        .byte %00011000         ; flame
        .byte %01100110
        .byte %11111111
        .byte %11111111
        .byte %01111110
        .byte %00100100         ; window
        .byte %00111100
        .byte %00011000
        ds 72, 0
        .byte %00100100
        .byte %01111110
        .byte %11111111
        .byte %11111111
        .byte %01111110
        .byte %00100100
        .byte %00111100
        .byte %00011000
        ds 72, 0

        align 256
BurstShapes
        ds 80, 0
        .byte %10010001
        .byte %01001010
        .byte %00100100
        .byte %11011011
        .byte %00011000
        .byte %01100110
        .byte %10010001
        .byte %00100100
        ds 72, 0
        .byte %01000010
        .byte %00010000
        .byte %10000101
        .byte %00100000
        .byte %01001001
        .byte %00010010
        .byte %01000000
        .byte %10001001
        ds 72, 0

        align 256
ShipColours                     ; of a row; the shot is drawn in these as well
        ds 80, SHOT_COLOUR
        .byte $2C, $36, $96, $98, $9A, $1E, $9E, $0E
        ds 72, SHOT_COLOUR

        align 256
BurstColours
        ds 80, SHOT_COLOUR
        .byte $34, $36, $38, $2A, $1E, $2A, $38, $36
        ds 72, SHOT_COLOUR

; ==== Digits and title ===============================================================================
        align 256
        PAGE_BEGIN
        include "lib/font.asm"
FontTitle
        .byte $00, $F3, $8A, $8A, $F3, $8A, $8A, $F3
        .byte $00, $E8, $08, $08, $CF, $08, $08, $E7
        .byte $00, $A2, $A2, $A2, $AA, $AA, $B6, $22
        .byte $00, $82, $82, $82, $F3, $82, $82, $F9
        .byte $00, $2F, $28, $28, $E8, $28, $28, $C8
        .byte $00, $BE, $20, $20, $20, $20, $20, $20

        PAGE_END

; ==== Lanes and glitches =============================================================================
; The lanes, lowest first, for the kernel: it has no cycle to spare for an index that crosses a page.
        align 256
        PAGE_BEGIN
LaneColours     .byte $B0, $A0, $90, $70, $60
RailColours     .byte $A6, $96, $86, $76        ; the rails above lanes 0 to 3
GlitchColours   .byte $CA, $3A, $DC, $5A, $2C
LaneEnds        .byte 0, 16, 32, 48, 64         ; first row of every lane, less one

; Shapes: fifteen rows of a lane and one that is never read (the first). The kernel's pointers are set back
; by the lane's first row, up to 64: that many bytes of the page must come before.
        ds LaneColours + LANE_ROWS * (LANES - 1) - ., 0
GlitchShapes
GlitchMite
        .byte 0, 0, 0, 0
        .byte %01000010
        .byte %00100100
        .byte %01111110
        .byte %11011011
        .byte %11111111
        .byte %01111110
        .byte %00100100
        .byte %01000010
        .byte 0, 0, 0, 0

        .byte 0, 0, 0, 0
        .byte %00100100
        .byte %00100100
        .byte %01111110
        .byte %11011011
        .byte %11111111
        .byte %01111110
        .byte %00100100
        .byte %10000001
        .byte 0, 0, 0, 0
GlitchEye
        .byte 0, 0, 0, 0
        .byte %00011000
        .byte %01100110
        .byte %11000011
        .byte %10110001
        .byte %10110001
        .byte %11000011
        .byte %01100110
        .byte %00011000
        .byte 0, 0, 0, 0

        .byte 0, 0, 0, 0
        .byte %01011010
        .byte %00111100
        .byte %11000011
        .byte %10001101
        .byte %10001101
        .byte %11000011
        .byte %00111100
        .byte %01011010
        .byte 0, 0, 0, 0
GlitchBurst
        .byte 0, 0, 0, 0
        .byte %10010010
        .byte %01010100
        .byte %00000000
        .byte %11010110
        .byte %00000000
        .byte %01010100
        .byte %10010010
        .byte %00000000
        .byte 0, 0, 0, 0
GlitchBlank
        ds LANE_ROWS, 0
        PAGE_END
