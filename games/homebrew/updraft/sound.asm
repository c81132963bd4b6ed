; Sound: channel 0 plays the balloon's effects, channel 1 the darts, the crash and the fanfare.

EFFECT_PUFF     = 0
EFFECT_BIRD     = 1
EFFECT_STAR     = 2
EFFECT_DART     = 3
EFFECT_CRASH    = 4
EFFECT_WAVE     = 5

;                     puff  bird  star  dart crash  wave
EffectTone      .byte    8,    4,   12,    1,    8,   12     ; AUDCx
EffectStart     .byte   10,   90,  140,   30,   50,  240     ; pitch: AUDFx * 8
EffectSlide     .byte    8,  -10,   -7,    5,    3,   -6     ; added to the pitch in every frame
EffectLength    .byte   14,    8,   18,   24,   60,   36     ; frames
EffectVolume    .byte    8,    9,   10,    5,   15,   10     ; at most; falls with the frames left
