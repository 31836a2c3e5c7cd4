// This file is empty. Its target precompiles the headers of the tests (see test/CMakeLists.txt).
