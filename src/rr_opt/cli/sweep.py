"""stub"""


def sweep() -> None:
    """stub"""
