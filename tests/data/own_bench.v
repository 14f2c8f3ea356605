// A bench as a user writes it with the page on buses: the encoder is the page's own block.
`timescale 1ns / 1ps
`default_nettype none
module own_bench;
    reg clk = 1'b0;
    always #8.333 clk = ~clk;
    wire endat_clk0_o, endat_data0_o, endat_data0_oe;
@ENCODER@
    reg cyc = 1'b0, we = 1'b0;
    reg [10:0] adr = 11'd0;
    reg [31:0] dat = 32'd0, got = 32'd0, low = 32'd0, earlier = 32'd0;
    wire [31:0] answer;
    wire ack;
    my_card card (
        .clk_i(clk), .rst_i(1'b0), .trigger_i(1'b0),
        .wb_cyc_i(cyc), .wb_stb_i(cyc), .wb_we_i(we), .wb_adr_i(adr), .wb_dat_i(dat), .wb_sel_i(4'hF),
        .wb_dat_o(answer), .wb_ack_o(ack), .wb_err_o(), .irq_o(),
        .endat_clk0_o(endat_clk0_o), .endat_data0_o(endat_data0_o), .endat_data0_oe(endat_data0_oe), .endat_data0_i(line),
        .led_status_o(), .led_channel0_o()
    );

    task access(input write, input [10:0] address, input [31:0] value);
        begin
            @(posedge clk);
            #1 cyc = 1'b1;
            we = write;
            adr = address;
            dat = value;
            @(posedge clk);
            while (!ack)
                @(posedge clk);
            got = answer;
            #1 cyc = 1'b0;
        end
    endtask

    // Triggers, and polls with a limit: a trigger that was lost shows as stale, and is given again.
    real begun;
    integer tries;
    initial begin
        access(1'b0, 11'h180, 32'd0);
        earlier = got;
        tries = 0;
        while (got[15:0] === earlier[15:0] && tries < 2) begin
            tries = tries + 1;
            access(1'b1, 11'h009, 32'd1);
            got = earlier;
            begun = $realtime;
            while (got[15:0] === earlier[15:0] && $realtime - begun < 1.0e6)
                access(1'b0, 11'h180, 32'd0);
            if (got[15:0] === earlier[15:0]) begin
                access(1'b0, 11'h185, 32'd0);
                $display("no result, stale = %b", got[30]);
                got = earlier;
            end
        end
        if (got[15:0] === earlier[15:0] || !got[23])
            $display("FAIL status %h", got);
        $display("cause %0d", got[20:16]);
        access(1'b0, 11'h181, 32'd0);
        low = got;
        access(1'b0, 11'h182, 32'd0);
        if ({got & 32'hFFFF, low} === 64'h1234_5678)
            $display("PASS");
        else
            $display("FAIL position %h %h", got, low);
        $finish;
    end
endmodule
