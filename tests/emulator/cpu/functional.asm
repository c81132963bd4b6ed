; A program that checks every documented instruction in every addressing mode on the machine that runs it.
; STEP counts the checks passed; a check that fails stops the processor with its number in STEP. At the end
; RESULT is $A5. Everything happens in $80-$FF, the only RAM of a 2600.
        processor 6502

STEP    = $80
RESULT  = $81
SAVED   = $82           ; A, which a check would lose
ZP      = $90           ; operands; ZP+3 for indexed ones
POINTER = $A0           ; -> TABLE
TARGET  = $A2           ; -> ZP

        mac setp        ; flags: N V - - D I Z C
        lda #{1}
        pha
        plp
        endm

        mac check       ; P masked with $CF on the stack's top, A already compared: Z says equal
        bne .bad
        pla
        and #$CF
        cmp #{1}
        beq .good
.bad    jmp fail
.good   inc STEP
        endm

        mac expect_a    ; value, flags
        php
        sta SAVED
        cmp #{1}
        check {2}
        lda SAVED
        endm

        mac expect_x
        php
        cpx #{1}
        check {2}
        endm

        mac expect_y
        php
        cpy #{1}
        check {2}
        endm

        mac expect_at   ; address, value, flags
        php
        lda {1}
        cmp #{2}
        check {3}
        endm

        org $F000
start   cld
        ldx #$FF
        txs
        lda #0
        sta STEP
        sta RESULT
        lda #<TABLE
        sta POINTER
        lda #>TABLE
        sta POINTER+1
        lda #ZP
        sta TARGET
        lda #0
        sta TARGET+1

; Loads: immediate, zero page, absolute, indexed, indirect
        setp $00
        lda #$80
        expect_a $80,$80
        lda #$00
        expect_a $00,$03
        lda #$5A
        sta ZP
        sta ZP+3
        lda ZP
        expect_a $5A,$01
        ldx #3
        lda #0
        lda ZP,x
        expect_a $5A,$01
        lda TABLE+1
        expect_a $22,$01
        lda TABLE,x
        expect_a $84,$81
        ldy #2
        lda TABLE,y
        expect_a $33,$01
        lda (POINTER),y
        expect_a $33,$01
        ldx #$10
        lda (POINTER-$10,x)
        expect_a $11,$01
        ldx #$81
        expect_x $81,$81        ; CPX's own carry comes from expect_a before
        ldx ZP
        expect_x $5A,$01
        ldy #3
        ldx ZP,y
        expect_x $5A,$01
        ldx TABLE+3
        expect_x $84,$81
        ldx TABLE,y
        expect_x $84,$81
        ldy #$00
        expect_y $00,$03
        ldy ZP
        expect_y $5A,$01
        ldx #3
        ldy ZP,x
        expect_y $5A,$01
        ldy TABLE+2
        expect_y $33,$01
        ldy TABLE,x
        expect_y $84,$81

; Stores
        setp $41
        lda #$C7
        ldx #3
        ldy #2
        sta ZP
        expect_at ZP,$C7,$41
        lda #$C8
        sta ZP,x
        expect_at ZP+3,$C8,$C1
        lda #$C9
        sta ZP+1
        expect_at ZP+1,$C9,$C1
        lda #$CA
        dc.b $8D,ZP+1,$00       ; STA absolute
        expect_at ZP+1,$CA,$C1
        lda #$CB
        dc.b $9D,ZP,$00         ; STA absolute,X
        expect_at ZP+3,$CB,$C1
        lda #$CC
        dc.b $99,ZP,$00         ; STA absolute,Y
        expect_at ZP+2,$CC,$C1
        lda #$CD
        sta (TARGET),y
        expect_at ZP+2,$CD,$C1
        ldx #$22
        lda #$CE
        sta (TARGET-$22,x)
        expect_at ZP,$CE,$C1
        stx ZP
        expect_at ZP,$22,$41
        stx ZP,y
        expect_at ZP+2,$22,$41
        dc.b $8E,ZP+4,$00       ; STX absolute
        expect_at ZP+4,$22,$41
        ldx #5
        sty ZP
        expect_at ZP,$02,$41
        sty ZP,x
        expect_at ZP+5,$02,$41
        dc.b $8C,ZP+6,$00       ; STY absolute
        expect_at ZP+6,$02,$41

; Transfers, stack pointer
        setp $00
        lda #$90
        tax
        expect_x $90,$80
        lda #$00
        tay
        expect_y $00,$03
        ldx #$7F
        txa
        expect_a $7F,$01
        ldy #$F0
        tya
        expect_a $F0,$81
        tsx
        expect_x $FF,$81
        ldx #$E0
        txs
        lda #$42
        pha
        expect_at $E0,$42,$01
        lda #$00
        pla
        expect_a $42,$01
        tsx
        expect_x $E0,$81
        ldx #$FF
        txs
        setp $CF
        php
        pla
        cmp #$FF
        beq php_ok
        jmp fail
php_ok  inc STEP

; Flags
        setp $CF
        clc
        expect_at ZERO,$00,$CE
        setp $CF
        cld
        expect_at ZERO,$00,$C7
        setp $CF
        cli
        expect_at ZERO,$00,$CB
        setp $CF
        clv
        cld
        expect_at ZERO,$00,$87
        setp $00
        sec
        expect_at ZERO,$00,$01
        setp $00
        sei
        expect_at ZERO,$00,$04
        setp $00
        sed
        expect_at ZERO,$00,$08
        cld

; Logic and arithmetic, each mode on $0F, $F0, ...: ZP=$0F, ZP+3=$3C
        lda #$0F
        sta ZP
        lda #$3C
        sta ZP+3
        ldx #3
        ldy #2

        setp $00
        lda #$FF
        and #$0F
        expect_a $0F,$00
        and ZP
        expect_a $0F,$01
        and ZP,x
        expect_a $0C,$01
        and TABLE+1
        expect_a $00,$03
        lda #$FF
        and TABLE,x
        expect_a $84,$81
        lda #$FF
        and TABLE,y
        expect_a $33,$01
        lda #$F0
        and (POINTER),y
        expect_a $30,$01
        ldx #$10
        and (POINTER-$10,x)
        expect_a $10,$01

        ldx #3
        setp $00
        lda #$00
        ora #$40
        expect_a $40,$00
        ora ZP
        expect_a $4F,$01
        ora ZP,x
        expect_a $7F,$01
        lda #$00
        ora TABLE+1
        expect_a $22,$01
        ora TABLE,x
        expect_a $A6,$81
        ora TABLE,y
        expect_a $B7,$81
        lda #$00
        ora (POINTER),y
        expect_a $33,$01
        ldx #$10
        ora (POINTER-$10,x)
        expect_a $33,$01

        ldx #3
        setp $00
        lda #$FF
        eor #$0F
        expect_a $F0,$80
        eor ZP
        expect_a $FF,$81
        eor ZP,x
        expect_a $C3,$81
        eor TABLE+1
        expect_a $E1,$81
        eor TABLE,x
        expect_a $65,$01
        eor TABLE,y
        expect_a $56,$01
        eor (POINTER),y
        expect_a $65,$01
        ldx #$10
        eor (POINTER-$10,x)
        expect_a $74,$01

        ldx #3
        setp $00
        lda #$70
        adc #$10                ; overflow
        expect_a $80,$C0
        clc
        adc ZP
        expect_a $8F,$80
        sec
        adc ZP,x
        expect_a $CC,$80
        clc
        adc TABLE+1
        expect_a $EE,$80
        clc
        adc TABLE,x
        expect_a $72,$41        ; two negatives make a positive
        clc
        adc TABLE,y
        expect_a $A5,$C0
        clc
        adc (POINTER),y
        expect_a $D8,$80
        ldx #$10
        clc
        adc (POINTER-$10,x)
        expect_a $E9,$80

        ldx #3
        setp $01
        lda #$50
        sbc #$20
        expect_a $30,$01
        sec
        sbc ZP
        expect_a $21,$01
        clc
        sbc ZP,x
        expect_a $E4,$80
        sec
        sbc TABLE+1
        expect_a $C2,$81
        sec
        sbc TABLE,x
        expect_a $3E,$01
        sec
        sbc TABLE,y
        expect_a $0B,$01
        sec
        sbc (POINTER),y
        expect_a $D8,$80
        ldx #$10
        sec
        sbc (POINTER-$10,x)
        expect_a $C7,$81

        sed                     ; decimal
        sec
        lda #$58
        adc #$46
        cld
        expect_a $05,$01
        sed
        sec
        lda #$12
        sbc #$34
        cld
        expect_a $78,$00

; Compares
        ldx #3
        setp $40
        lda #$33
        cmp #$33
        expect_a $33,$43
        cmp #$34
        expect_a $33,$C0
        cmp ZP
        expect_a $33,$41
        cmp ZP,x
        expect_a $33,$C0
        cmp TABLE+1
        expect_a $33,$41
        cmp TABLE,x
        expect_a $33,$C0
        cmp TABLE,y
        expect_a $33,$43
        cmp (POINTER),y
        expect_a $33,$43
        ldx #$10
        cmp (POINTER-$10,x)
        expect_a $33,$41
        cpx #$11
        expect_x $10,$C0
        cpx ZP
        expect_x $10,$41
        cpx TABLE
        expect_x $10,$C0
        cpy #$02
        expect_y $02,$43
        cpy ZP
        expect_y $02,$C0
        cpy TABLE
        expect_y $02,$C0
        lda #$C0
        sta ZP
        lda #$0F
        bit ZP
        expect_a $0F,$C3
        bit TABLE+1
        expect_a $0F,$01

; Shifts, INC and DEC
        mac shift       ; name, accumulator before, after, flags before, after
        setp {4}
        lda #{2}
        {1}
        expect_a {3},{5}
        endm
        mac shift_at    ; the same at ZP in each mode; X = 3
        lda #{2}
        sta ZP
        sta ZP+3
        sta ZP+4
        sta ZP+7
        setp {4}
        ldx #3
        {1} ZP
        expect_at ZP,{3},{5}
        setp {4}
        ldx #3
        {1} ZP,x
        expect_at ZP+3,{3},{5}
        endm
        mac absolute    ; opcode of the absolute mode, of absolute,X
        setp {4}
        ldx #3
        dc.b {1},ZP+4,$00
        expect_at ZP+4,{3},{5}
        setp {4}
        ldx #3
        dc.b {2},ZP+4,$00
        expect_at ZP+7,{3},{5}
        endm

        shift asl,$C1,$82,$00,$81
        shift_at asl,$C1,$82,$00,$81
        absolute $0E,$1E,$82,$00,$81
        shift lsr,$01,$00,$00,$03
        shift_at lsr,$01,$00,$00,$03
        absolute $4E,$5E,$00,$00,$03
        shift rol,$80,$01,$01,$01
        shift_at rol,$80,$01,$01,$01
        absolute $2E,$3E,$01,$01,$01
        shift ror,$02,$81,$01,$80
        shift_at ror,$02,$81,$01,$80
        absolute $6E,$7E,$81,$01,$80
        shift_at inc,$FF,$00,$41,$43
        absolute $EE,$FE,$00,$41,$43
        shift_at dec,$00,$FF,$41,$C1
        absolute $CE,$DE,$FF,$41,$C1
        setp $00
        ldx #$FF
        inx
        expect_x $00,$02
        dex
        expect_x $FF,$81
        ldy #$7F
        iny
        expect_y $80,$81
        dey
        expect_y $7F,$01
        setp $C3
        nop
        expect_y $7F,$C3

; Branches, each taken and not taken
        mac branches    ; name, flags that take it, flags that don't
        setp {2}
        {1} .here
        jmp fail
.here   setp {3}
        {1} .wrong
        jmp .done
.wrong  jmp fail
.done   inc STEP
        endm
        branches bpl,$4F,$80
        branches bmi,$80,$4F
        branches bvc,$8F,$40
        branches bvs,$40,$8F
        branches bcc,$CE,$01
        branches bcs,$01,$CE
        branches bne,$CD,$02
        branches beq,$02,$CD
        cld

; Jumps, subroutines, interrupts
        jmp (VECTOR)
        jmp fail
landed  inc STEP
        ldx #$FF
        txs
        setp $00
        jsr routine
back    expect_a $77,$00
        lda #>resume
        pha
        lda #<resume
        pha
        lda #$C3
        pha
        rti
        jmp fail
resume  expect_at ZERO,$00,$C3
        setp $C3
        brk
        dc.b $EA                ; skipped
        expect_a $B7,$C3
        expect_at $FD,$F3,$C1
        tsx
        expect_x $FF,$C1

        lda #$A5
        sta RESULT
done    jmp done

routine tsx
        cpx #$FD
        bne fail
        lda $FF                 ; the address of the last byte of JSR
        cmp #>(back-1)
        bne fail
        lda $FE
        cmp #<(back-1)
        bne fail
        lda #$77
        clc
        rts

interrupt
        php                     ; I is set, the others as they were
        pla
        cmp #$F7
        beq set
        jmp fail
set     pla                     ; P as pushed, with I clear
        pha
        cmp #$F3
        beq pushed
        jmp fail
pushed  inc STEP
        lda #$B7
        sec
        rti
fail    dc.b $02                ; stops the processor

        org $FFE0
ZERO    dc.b $00
TABLE   dc.b $11,$22,$33,$84
VECTOR  dc.w landed

        org $FFFA
        dc.w fail,start,interrupt
