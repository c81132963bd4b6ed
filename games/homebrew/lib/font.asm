; Digits and a blank, lowest line first. To be included at the start of a page.

Font
        .byte $3C, $66, $66, $66, $66, $66, $66, $3C    ; 0
        .byte $7E, $18, $18, $18, $18, $18, $38, $18    ; 1
        .byte $7E, $60, $60, $3C, $06, $06, $46, $3C    ; 2
        .byte $3C, $46, $06, $06, $1C, $06, $46, $3C    ; 3
        .byte $0C, $0C, $0C, $7E, $4C, $2C, $1C, $0C    ; 4
        .byte $7C, $46, $06, $06, $7C, $60, $60, $7E    ; 5
        .byte $3C, $66, $66, $66, $7C, $60, $62, $3C    ; 6
        .byte $18, $18, $18, $18, $0C, $06, $42, $7E    ; 7
        .byte $3C, $66, $66, $3C, $3C, $66, $66, $3C    ; 8
        .byte $3C, $46, $06, $3E, $66, $66, $66, $3C    ; 9
FontBlank
        .byte 0, 0, 0, 0, 0, 0, 0, 0
