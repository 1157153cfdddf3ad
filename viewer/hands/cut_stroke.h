// A cut drawn over the picture. Each step of the pointer sweeps a plane through the eye; where it meets the
// cloth, be it hidden by other layers or not, lines run over the flat sheet: cuts of the scene. Because they
// are kept on the sheet, not in space, a stroke over moving cloth stays in one piece.
#pragma once

#include <map>
#include <vector>

#include "hands/pick.h"

namespace weft::viewer {

using GridPoint = std::array<double, 2>;  // [column, row]

class CutStroke {
 public:
  void begin(float x, float y);
  // Goes on to another place of the pointer; whether it has cut anything.
  bool go_on(const FrameData& frame_data, const Camera& camera, const Area& area, float x, float y);
  // What has been cut of a cloth since begin().
  const std::vector<CutLine>& lines(std::size_t cloth) const;
  // Places of the pointer, for drawing.
  const std::vector<std::array<float, 2>>& points() const { return points_; }
  void end();

 private:
  // A line that ends under the pointer, and may go on from there.
  struct Open {
    std::size_t cloth, line;
  };
  // One step over one cloth.
  bool step(const ClothCopy& cloth, const Grid& grid, std::size_t number, const Projector& project,
            const std::array<ScreenPoint, 2>& way);

  std::vector<std::array<float, 2>> points_;
  std::map<std::size_t, std::vector<CutLine>> lines_;
  std::vector<Open> open_;
};

}  // namespace weft::viewer
