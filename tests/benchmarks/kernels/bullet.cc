// fingertip-bullet SIZE STEPS: what a step of Bullet's soft body costs on a cube of SIZE³ nodes
// whose 26 neighbours are joined by links, on one thread, in double precision. Prints one JSON
// object. A step predicts the motion, projects every link once (position-based dynamics) and
// integrates.
#include <BulletSoftBody/btSoftBody.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

namespace {

/// Node numbers of a cube, x fastest, and its links to the neighbours that follow.
void join(btSoftBody& body, int size) {
  const auto index = [size](int x, int y, int z) { return (z * size + y) * size + x; };
  for (int z = 0; z < size; ++z)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        for (int direction = 14; direction < 27; ++direction) {  // the half that follows the centre
          const int i = x + direction % 3 - 1, j = y + direction / 3 % 3 - 1,
                    k = z + direction / 9 - 1;
          if (i < 0 || j < 0 || k < 0 || i >= size || j >= size || k >= size) continue;
          body.appendLink(index(x, y, z), index(i, j, k), nullptr, false);
        }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: fingertip-bullet SIZE STEPS\n");
    return 2;
  }
  const int size = std::atoi(argv[1]), steps = std::atoi(argv[2]);
  if (size < 2 || steps < 1) {
    std::fprintf(stderr, "fingertip-bullet: SIZE must be at least 2, STEPS at least 1\n");
    return 2;
  }
  btSoftBodyWorldInfo world;
  world.m_gravity = btVector3(0, 0, 0);
  world.m_sparsesdf.Initialize();
  std::vector<btVector3> nodes;
  for (int z = 0; z < size; ++z)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) nodes.emplace_back(x, y, z);
  btSoftBody body(&world, int(nodes.size()), nodes.data(), nullptr);
  join(body, size);
  for (int i = 0; i < body.m_nodes.size(); ++i)
    body.m_nodes[i].m_v = btVector3(0.01 * (i % 7 - 3), 0, 0);
  body.m_cfg.piterations = 1;
  body.m_materials[0]->m_kLST = 0.5;
  const auto step = [&] {
    body.predictMotion(1e-3);
    body.solveConstraints();
    body.integrateMotion();
  };
  step();
  const std::clock_t start = std::clock();  // processor time: others may use the machine
  for (int n = 0; n < steps; ++n) step();
  const double elapsed = double(std::clock() - start) / CLOCKS_PER_SEC;
  std::printf("{\"masses\": %d, \"springs\": %d, \"steps\": %d, \"seconds\": %.9g}\n",
              body.m_nodes.size(), body.m_links.size(), steps, elapsed);
}
