"""The packages, and the folder protocols/ as one of them, which pyproject.toml cannot say; all else stands there."""

from setuptools import find_namespace_packages, setup

setup(
    packages=[*find_namespace_packages(include=["benchlab*"]), "benchlab.protocols"],
    package_dir={"benchlab.protocols": "protocols"},
)
