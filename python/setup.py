"""Packs the module that CMake has built; python/wheel calls this in a folder with all that it needs."""

import os

import setuptools


class Built(setuptools.Distribution):
    """Has a compiled module, which setuptools has not built itself."""

    def has_ext_modules(self):
        return True


setuptools.setup(
    name="weft",
    version=os.environ["WEFT_VERSION"],
    description="Fast and accurate cloth simulation on the CPU",
    license="MIT",
    packages=["weft"],
    package_data={"weft": ["*.so", "*.pyi", "py.typed", "scenes/*.json", "LICENSE", "THIRD_PARTY.md"]},
    python_requires=">=3.9",
    install_requires=["numpy"],
    extras_require={"study": ["h5py"], "cluster": ["distributed"], "plots": ["matplotlib"]},
    distclass=Built,
)
