# The techniques that change the map's geometry or what it stores.
gnomon_test(technique_gl_test TIMEOUT 900
  SOURCES technique_bias_gl_test.cpp technique_cascade_gl_test.cpp technique_izb_gl_test.cpp technique_twin_gl_test.cpp
  LIBS compare_support)
# Orthographic cameras, in both renderers and every technique.
gnomon_test(orthographic_gl_test SOURCES orthographic_gl_test.cpp LIBS compare_support gnomon::hybrid)
# Objects that cast no shadow, or receive none.
gnomon_test(casting_gl_test SOURCES casting_gl_test.cpp LIBS compare_support gnomon::hybrid)
