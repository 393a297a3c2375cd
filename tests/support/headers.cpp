// A source for the target that makes the tests' precompiled header (tests/CMakeLists.txt).
