gnomon_test(hybrid_test
  SOURCES hybrid_classify_test.cpp hybrid_sheets_test.cpp hybrid_solids_test.cpp hybrid_soft_test.cpp hybrid_surfaces_test.cpp
  LIBS gnomon::hybrid raytrace_support TBB::tbb)

gnomon_test(hybrid_gl_test
  SOURCES hybrid_gl_test.cpp
  LIBS gnomon::compare gnomon::hybrid)
