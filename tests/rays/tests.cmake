gnomon_test(rays_test
  SOURCES rays_denoisers_test.cpp rays_samples_test.cpp
  LIBS gnomon::rays raytrace_support TBB::tbb)

gnomon_test(rays_gl_test
  SOURCES rays_gl_test.cpp
  LIBS gnomon::compare gnomon::rays TBB::tbb)
