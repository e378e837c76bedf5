"""Reads a binary glTF far enough to check it: nodes in the world, triangles, extras.  Plain Python."""

import json
import struct

TYPES = {5121: ("B", 1), 5123: ("H", 2), 5125: ("I", 4), 5126: ("f", 4)}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Glb:
    def __init__(self, path):
        data = open(path, "rb").read()
        magic, version, size = struct.unpack_from("<4sII", data)
        assert (magic, version, size) == (b"glTF", 2, len(data)), "not a whole binary glTF 2.0 file"
        json_size = struct.unpack_from("<I", data, 12)[0]
        self.size = size
        self.kept = {}
        self.json = json.loads(data[20 : 20 + json_size])
        self.binary = data[20 + json_size + 8 :]
        self.nodes = self.json["nodes"]
        self.parents = {child: i for i, node in enumerate(self.nodes) for child in node.get("children", ())}

    def accessor(self, index):
        """Rows of one (dense) accessor."""
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        letter, size = TYPES[accessor["componentType"]]
        width = WIDTHS[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", size * width)
        return [
            struct.unpack_from(f"<{width}{letter}", self.binary, start + i * stride) for i in range(accessor["count"])
        ]

    def triangles(self, mesh):
        """Corner positions of every triangle of a mesh."""
        for primitive in self.json["meshes"][mesh]["primitives"]:
            points = self.accessor(primitive["attributes"]["POSITION"])
            indices = [row[0] for row in self.accessor(primitive["indices"])]
            for i in range(0, len(indices), 3):
                yield tuple(points[j] for j in indices[i : i + 3])

    def triangles_of(self, mesh):
        """The same as a list, kept for meshes that many nodes share."""
        if mesh not in self.kept:
            self.kept[mesh] = list(self.triangles(mesh))
        return self.kept[mesh]

    def triangle_count(self, mesh):
        accessors = self.json["accessors"]
        return sum(accessors[p["indices"]]["count"] // 3 for p in self.json["meshes"][mesh]["primitives"])

    def to_world(self, index, point):
        """A node's point in the world."""
        while index is not None:
            node = self.nodes[index]
            assert "matrix" not in node
            point = [a * b for a, b in zip(point, node.get("scale", (1, 1, 1)))]
            point = _rotate(node.get("rotation", (0, 0, 0, 1)), point)
            point = [a + b for a, b in zip(point, node.get("translation", (0, 0, 0)))]
            index = self.parents.get(index)
        return point


def _rotate(quaternion, v):
    x, y, z, w = quaternion
    tx, ty, tz = 2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])
    return [v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz, v[2] + w * tz + x * ty - y * tx]
