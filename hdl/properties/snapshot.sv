// one_set: Position, width, CRC, F2 and time change together, and only with a good result, or when the previous position replaces a withdrawn one.
// one_number_each: Each result has the next number, and nothing else changes it.
// bad_is_not_fresh: A result without a good position leaves the position unchanged and clears `fresh`.
// faults_with_results: Cause and flags change only with a result, with a fault after it, or when a check finds the stored position changed.
// restored unless NEVER_WITHDRAWS (positions that are never withdrawn): A position that is withdrawn before the next frame gives way to the last good one, with its time, or to none if there was none; where that is not kept, no position is valid.
reg f_past_valid; initial f_past_valid = 1'b0;
wire [91:0] f_set = {held, held_crc, held_width, held_f2, stamp};
always @(posedge clock) begin
    f_past_valid <= 1'b1;
    if (f_past_valid & !$past(reset)) begin
        one_set: assert ($stable(f_set) | $past(take_good | take_back));
        one_set_strobe: assert (result_strobe == $past(publish));
        one_number_each: assert (count == $past(count) + {15'd0, $past(publish)});
        if ($past(publish & !good & !take_back)) bad_is_not_fresh: assert (!is_fresh & $stable(f_set));
        if (!$past(publish | late_fault | upset_now)) faults_with_results: assert ($stable({cause_held, flags_held}));
    end
end
// without NEVER_CONFIRMS
always @(posedge clock) if (f_past_valid & !$past(reset)) begin
    if ($past(valid & !unconfirmed & !upset_now)) restored_only: assert (valid);
end
// end
// without RESTORES
always @(posedge clock) if (f_past_valid & !$past(reset)) begin
    if (!NEVER_WITHDRAWS & $past(take_back & !take_good)) restored: assert (!is_fresh & !valid);
end
// end
// with RESTORES
reg [91:0] f_last; reg f_last_valid;
// the next frame has begun
reg f_newer; initial f_newer = 1'b0;
always @(posedge clock) begin
    if (take_good) begin
        f_last <= f_set;
        f_last_valid <= valid;
        f_newer <= 1'b0;
    end
    if (first_fall | latched) f_newer <= 1'b1;
    if (reset) f_newer <= 1'b0;
end
always @* restored_same: assert (!f_past_valid | !unconfirmed | f_newer | ({earlier_width, earlier_f2, stamp_pending, earlier_valid} == {f_last[38:0], f_last_valid}));
// end
// with SWAPS
// the receiver has the position meanwhile: word_kept
always @(posedge clock) if (f_past_valid & !$past(reset)) begin
    if ($past(take_back & !take_good & !f_newer)) restored: assert (!is_fresh & (f_set == $past({position_in, crc_received_in, f_last[38:0]})) & (valid == $past(f_last_valid & !upset_now)));
end
// end
// with KEEPS
always @* restored_kept: assert (!f_past_valid | !unconfirmed | ({earlier, earlier_crc} == f_last[91:39]));
always @(posedge clock) if (f_past_valid & !$past(reset)) begin
    if ($past(take_back & !take_good & !f_newer)) restored: assert (!is_fresh & (f_set == $past(f_last)) & (valid == $past(f_last_valid & !upset_now)));
end
// end
// with HAS_GUARDS
// at rest the stored position fits its parity; the proof of a frame begins and ends there
wire f_whole = loaded | (parity_now == parity);
// end
// without HAS_GUARDS
wire f_whole = 1'b1;
// end
