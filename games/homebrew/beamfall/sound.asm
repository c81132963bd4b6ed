; Sound: channel 0 plays the ship's effects, channel 1 the crash and the fanfare; when channel 1 is free
; the beam hums there, higher the lower it gets.

EFFECT_SHOT     = 0
EFFECT_BURN     = 1
EFFECT_GLITCH   = 2
EFFECT_SPARK    = 3
EFFECT_PASS     = 4
EFFECT_CRASH    = 5
EFFECT_WAVE     = 6

;                      shot  burn  glitch spark pass crash wave
EffectTone      .byte     4,    8,    12,    4,   12,    8,   4     ; AUDCx
EffectStart     .byte    24,   20,    40,  200,  160,   60, 248     ; pitch: AUDFx * 8
EffectSlide     .byte    12,   10,     9,  -11,   -9,    3, -6   ; added to the pitch in every frame
EffectLength    .byte    10,    8,    16,   16,   14,   60,  36     ; frames
EffectVolume    .byte     6,    7,    10,   10,    8,   15,  10     ; at most; falls with the frames left

; Once a frame.
Sound subroutine
        jsr PlayEffects
        lda effectTime+1
        bne .rts
        lda phase
        cmp #PHASE_PLAY
        bne .rts
        lda beamRow
        lsr
        lsr
        sta AUDF1
        lda #6
        sta AUDC1
        lda frame               ; it throbs
        lsr
        lsr
        lsr
        and #1
        adc #1
        sta AUDV1
.rts    rts
