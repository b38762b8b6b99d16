// write_values FILE: the values to be judged, at the centres of 4 x 4 cells of the floor.
#include <cstdio>

#include "form_factor.h"

int main(int count, char** arguments) {
  std::FILE* file = count == 2 ? std::fopen(arguments[1], "w") : nullptr;
  if (file == nullptr) return 2;
  std::fputs("x,y,z,value\n", file);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      const Point p{i + 0.5, j + 0.5, 0.0};
      std::fprintf(file, "%.17g,%.17g,0,%.17g\n", p.x, p.y, sampled_form_factor(p));
    }
  }
  return std::fclose(file) == 0 ? 0 : 1;
}
