; Sound effects: one at a time on each channel, as tables of the game tell:
;   EffectTone AUDCx, EffectStart and EffectSlide the pitch (AUDFx * 8) and what is added to it in every frame,
;   EffectLength in frames, EffectVolume at most; the volume falls with the frames left.

; Effect Y on channel X.
StartEffect subroutine
        sty effect,x
        lda EffectStart,y
        sta effectPitch,x
        lda EffectLength,y
        sta effectTime,x
        rts

; Once a frame: both channels.
PlayEffects subroutine
        ldx #1
.channel
        lda effectTime,x
        beq .silent
        dec effectTime,x
        ldy effect,x
        lda EffectTone,y
        sta AUDC0,x
        lda effectPitch,x
        lsr
        lsr
        lsr
        sta AUDF0,x
        lda effectPitch,x
        clc
        adc EffectSlide,y
        sta effectPitch,x
        lda effectTime,x
        cmp EffectVolume,y
        bcc .volume
        lda EffectVolume,y
.volume sta AUDV0,x
        jmp .next
.silent sta AUDV0,x
.next   dex
        bpl .channel
        rts
