"""The report of what was explained: verdict, where, what, rivals, the gap before and after, what is left, the next experiment."""
